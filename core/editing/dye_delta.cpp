// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/dye_delta.h"

#include <utility>

#include "core/groom/point_dye.h"

namespace hairloom::editing {

void DyeDelta::keep(Groom& groom, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    if (mask_.empty()) {
        absent_ = !groom.pointAttributes.has(attribute::kPointDye);
        turnsOn_ = groom.material.dyeStrength <= 0;
        if (absent_) groom.pointAttributes.set(attribute::kPointDye, pointDyes(groom));
        strength_ = turnsOn_ ? std::exchange(groom.material.dyeStrength, 1.0f) : 0.0f;
    }
    mask_.keep(groom.offsets.view(), groom.pointAttributes.view<float>(attribute::kPointDye), strands);
}

void DyeDelta::finish(Groom& groom) {
    if (mask_.empty()) return;
    mask_.finish(groom.offsets.view(), groom.pointAttributes.view<float>(attribute::kPointDye));
    if (!mask_.empty()) return;
    if (absent_) groom.pointAttributes.erase(attribute::kPointDye);
    if (turnsOn_) groom.material.dyeStrength = strength_;
    *this = {};
}

void DyeDelta::exchange(Groom& groom) {
    if (mask_.empty()) return;
    const bool absentNow = !groom.pointAttributes.has(attribute::kPointDye);
    // Of the material as it is on this side.
    if (absentNow) groom.pointAttributes.set(attribute::kPointDye, pointDyes(groom));
    mask_.exchange(groom.offsets.view(), groom.pointAttributes.edit<float>(attribute::kPointDye));
    if (absent_) groom.pointAttributes.erase(attribute::kPointDye);
    absent_ = absentNow;
    if (turnsOn_) std::swap(groom.material.dyeStrength, strength_);
}

}  // namespace hairloom::editing
