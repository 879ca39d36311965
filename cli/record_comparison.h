// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far hair is from a record of the same groom and frames.

#include <cstdint>
#include <span>
#include <string>

#include "cli/job.h"
#include "core/groom/groom.h"

namespace hairloom::cli {

class RecordComparison {
  public:
    explicit RecordComparison(std::string path) : path_(std::move(path)) {}

    /// Errors: as readFrame().
    Status add(const Groom& groom, std::uint64_t frame, std::span<const Vec3f> positions_ws);

    double meanMm() const;  ///< root of the mean square over all points of all frames
    double maxMm() const;
    /// error_mm, error_mm_max
    void report(Report& report) const;

  private:
    std::string path_;
    double sum_ = 0, largest_ = 0;
    std::size_t count_ = 0;
};

}  // namespace hairloom::cli
