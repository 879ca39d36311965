// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/attribute_delta.h"

#include <numeric>

namespace hairloom::editing {

AttributeSet& AttributeDelta::attributesOf(Groom& groom) const {
    return of_ == Of::strands ? groom.strandAttributes : groom.pointAttributes;
}

std::vector<float>& AttributeDelta::valuesOf(Groom& groom) const {
    std::vector<float>& values = attributesOf(groom).edit<float>(name_);
    values.resize(of_ == Of::strands ? groom.strandCount() : groom.pointCount(), 0.0f);
    return values;
}

std::span<const std::uint32_t> AttributeDelta::offsetsOf(const Groom& groom,
                                                         std::vector<std::uint32_t>& ones) const {
    if (of_ == Of::points) return groom.offsets.view();
    ones.resize(groom.strandCount() + 1);
    std::iota(ones.begin(), ones.end(), 0u);
    return ones;
}

void AttributeDelta::keep(Groom& groom, std::string_view name, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    if (values_.empty()) {
        name_ = name;
        absent_ = !attributesOf(groom).has(name_);
    }
    std::vector<std::uint32_t> ones;
    values_.keep(offsetsOf(groom, ones), valuesOf(groom), strands);
}

void AttributeDelta::finish(Groom& groom) {
    if (values_.empty()) return;
    std::vector<std::uint32_t> ones;
    values_.finish(offsetsOf(groom, ones), attributesOf(groom).view<float>(name_));
    if (!values_.empty()) return;
    if (absent_) attributesOf(groom).erase(name_);
    *this = AttributeDelta(of_);
}

void AttributeDelta::exchange(Groom& groom) {
    if (values_.empty()) return;
    const bool absentNow = !attributesOf(groom).has(name_);
    std::vector<std::uint32_t> ones;
    values_.exchange(offsetsOf(groom, ones), valuesOf(groom));
    if (absent_) attributesOf(groom).erase(name_);
    absent_ = absentNow;
}

}  // namespace hairloom::editing
