// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/dye_delta.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/groom/point_dye.h"

namespace hairloom::editing {

void DyeDelta::keep(Groom& groom, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    if (strands_.empty()) {
        absent_ = !groom.pointAttributes.has(attribute::kPointDye);
        turnsOn_ = groom.material.dyeStrength <= 0;
        if (absent_) groom.pointAttributes.set(attribute::kPointDye, pointDyes(groom));
        strength_ = turnsOn_ ? std::exchange(groom.material.dyeStrength, 1.0f) : 0.0f;
    }
    isKept_.resize(groom.strandCount(), 0);
    const auto mask = groom.pointAttributes.view<float>(attribute::kPointDye);
    for (const std::uint32_t s : strands) {
        if (std::exchange(isKept_[s], std::uint8_t{1}) != 0) continue;
        const auto values = mask.subspan(groom.offsets[s], groom.offsets[s + 1] - groom.offsets[s]);
        strands_.push_back(s);
        values_.insert(values_.end(), values.begin(), values.end());
        begins_.push_back(static_cast<std::uint32_t>(values_.size()));
    }
}

void DyeDelta::finish(Groom& groom) {
    if (strands_.empty()) return;
    const auto mask = groom.pointAttributes.view<float>(attribute::kPointDye);
    const auto valuesOf = [this](std::size_t k) {
        return std::span<const float>(values_).subspan(begins_[k], begins_[k + 1] - begins_[k]);
    };
    std::vector<std::size_t> order(strands_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t k) {
        const auto before = valuesOf(k);
        return std::ranges::equal(before, mask.subspan(groom.offsets[strands_[k]], before.size()));
    });
    std::ranges::sort(order, {}, [this](std::size_t k) { return strands_[k]; });
    DyeDelta sorted;
    sorted.absent_ = absent_;
    sorted.turnsOn_ = turnsOn_;
    sorted.strength_ = strength_;
    for (const std::size_t k : order) {
        const auto values = valuesOf(k);
        sorted.strands_.push_back(strands_[k]);
        sorted.values_.insert(sorted.values_.end(), values.begin(), values.end());
        sorted.begins_.push_back(static_cast<std::uint32_t>(sorted.values_.size()));
    }
    if (order.empty()) {
        if (absent_) groom.pointAttributes.erase(attribute::kPointDye);
        if (turnsOn_) groom.material.dyeStrength = strength_;
        sorted = {};
    }
    *this = std::move(sorted);
}

void DyeDelta::exchange(Groom& groom) {
    if (strands_.empty()) return;
    const bool absentNow = !groom.pointAttributes.has(attribute::kPointDye);
    // Of the material as it is on this side.
    if (absentNow) groom.pointAttributes.set(attribute::kPointDye, pointDyes(groom));
    std::vector<float>& mask = groom.pointAttributes.edit<float>(attribute::kPointDye);
    for (std::size_t k = 0; k < strands_.size(); ++k) {
        std::swap_ranges(values_.begin() + begins_[k], values_.begin() + begins_[k + 1],
                         mask.begin() + groom.offsets[strands_[k]]);
    }
    if (absent_) groom.pointAttributes.erase(attribute::kPointDye);
    absent_ = absentNow;
    if (turnsOn_) std::swap(groom.material.dyeStrength, strength_);
}

std::size_t DyeDelta::bytes() const {
    return sizeof(*this) + values_.capacity() * sizeof(float) +
           (strands_.capacity() + begins_.capacity()) * sizeof(std::uint32_t) + isKept_.capacity();
}

}  // namespace hairloom::editing
