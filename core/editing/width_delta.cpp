// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/width_delta.h"

#include "core/groom/point_width.h"

namespace hairloom::editing {
namespace {

std::vector<float>& widthsOf(Groom& groom) {
    std::vector<float>& values = groom.pointAttributes.edit<float>(attribute::kWidthChange);
    values.resize(groom.pointCount(), 0.0f);
    return values;
}

}  // namespace

void WidthDelta::keep(Groom& groom, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    if (values_.empty()) absent_ = !groom.pointAttributes.has(attribute::kWidthChange);
    values_.keep(groom.offsets.view(), widthsOf(groom), strands);
}

void WidthDelta::finish(Groom& groom) {
    if (values_.empty()) return;
    values_.finish(groom.offsets.view(), groom.pointAttributes.view<float>(attribute::kWidthChange));
    if (!values_.empty()) return;
    if (absent_) groom.pointAttributes.erase(attribute::kWidthChange);
    *this = {};
}

void WidthDelta::exchange(Groom& groom) {
    if (values_.empty()) return;
    const bool absentNow = !groom.pointAttributes.has(attribute::kWidthChange);
    values_.exchange(groom.offsets.view(), widthsOf(groom));
    if (absent_) groom.pointAttributes.erase(attribute::kWidthChange);
    absent_ = absentNow;
}

}  // namespace hairloom::editing
