// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/point_delta.h"

#include <utility>

namespace hairloom::editing {

void FlagDelta::set(Groom& groom, std::span<const std::uint32_t> strands, bool value) {
    const auto now = groom.strandAttributes.view<std::uint8_t>(attribute_);
    const std::uint8_t wanted = value ? 1 : 0;
    std::vector<std::uint32_t> changed;
    for (const std::uint32_t s : strands) {
        if ((s < now.size() ? now[s] : 0) != wanted) changed.push_back(s);
    }
    if (changed.empty()) return;
    if (strands_.empty()) absent_ = !groom.strandAttributes.has(attribute_);
    std::vector<std::uint8_t>& flags = groom.strandAttributes.edit<std::uint8_t>(attribute_);
    flags.resize(groom.strandCount(), 0);
    std::vector<std::uint32_t> strandsNow;
    std::vector<std::uint8_t> valuesNow;
    std::size_t old = 0;
    const auto copyOld = [&] {
        strandsNow.push_back(strands_[old]);
        valuesNow.push_back(values_[old++]);
    };
    for (const std::uint32_t s : changed) {
        while (old < strands_.size() && strands_[old] < s) copyOld();
        if (old < strands_.size() && strands_[old] == s) {
            copyOld();
        } else {
            strandsNow.push_back(s);
            valuesNow.push_back(flags[s]);
        }
        flags[s] = wanted;
    }
    while (old < strands_.size()) copyOld();
    strands_ = std::move(strandsNow);
    values_ = std::move(valuesNow);
}

void FlagDelta::exchange(Groom& groom) {
    if (strands_.empty()) return;
    const bool absentNow = !groom.strandAttributes.has(attribute_);
    std::vector<std::uint8_t>& flags = groom.strandAttributes.edit<std::uint8_t>(attribute_);
    flags.resize(groom.strandCount(), 0);
    for (std::size_t k = 0; k < strands_.size(); ++k) std::swap(flags[strands_[k]], values_[k]);
    if (absent_) groom.strandAttributes.erase(attribute_);
    absent_ = absentNow;
}

}  // namespace hairloom::editing
