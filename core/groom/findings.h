// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shared by the parts of validate().

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/groom/validate.h"

namespace hairloom {

/// The places where one kind of trouble was met; only the first is spelt out.
class Places {
  public:
    void strand(std::size_t index) {
        if (count_++ == 0) first_ = fmt::format("strand {}", index);
    }
    void point(std::size_t strandIndex, std::size_t pointIndex) {
        if (count_++ == 0) first_ = fmt::format("strand {}, point {}", strandIndex, pointIndex);
    }
    void other(std::string_view what, std::size_t index) {
        if (count_++ == 0) first_ = fmt::format("{} {}", what, index);
    }
    void named(const std::string& name) {
        if (count_++ == 0) first_ = name;
    }
    /// One finding, if there was any place.
    void report(std::vector<Finding>& findings, Severity severity, std::string what, std::string fix) const {
        if (count_ == 0) return;
        const std::string more = count_ > 1 ? fmt::format(" and {} more", count_ - 1) : std::string();
        findings.push_back({severity, std::move(what), first_ + more, std::move(fix)});
    }

  private:
    std::size_t count_ = 0;
    std::string first_;
};

/// Appends what is wrong with offsets, array lengths, types and indices. False when the arrays cannot be
/// walked.
bool findStructure(const Groom& groom, std::vector<Finding>& findings);
/// Appends what is wrong with values; the groom's structure must hold.
void findGeometry(const Groom& groom, std::vector<Finding>& findings);
void findBinding(const Groom& groom, std::vector<Finding>& findings);

}  // namespace hairloom
