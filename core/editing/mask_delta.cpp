// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/mask_delta.h"

#include <numeric>
#include <vector>

#include "core/operations/mask.h"

namespace hairloom::editing {
namespace {

/// As StrandValues wants them: each strand has one value.
std::vector<std::uint32_t> oneEach(const Groom& groom) {
    std::vector<std::uint32_t> offsets(groom.strandCount() + 1);
    std::iota(offsets.begin(), offsets.end(), 0u);
    return offsets;
}

std::vector<float>& valuesOf(Groom& groom, std::uint32_t number) {
    std::vector<float>& values = groom.strandAttributes.edit<float>(maskAttribute(number));
    values.resize(groom.strandCount(), 0.0f);
    return values;
}

}  // namespace

void MaskDelta::keep(Groom& groom, std::uint32_t number, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    if (values_.empty()) {
        number_ = number;
        absent_ = !groom.strandAttributes.has(maskAttribute(number));
    }
    values_.keep(oneEach(groom), valuesOf(groom, number_), strands);
}

void MaskDelta::finish(Groom& groom) {
    if (values_.empty()) return;
    values_.finish(oneEach(groom), groom.strandAttributes.view<float>(maskAttribute(number_)));
    if (!values_.empty()) return;
    if (absent_) groom.strandAttributes.erase(maskAttribute(number_));
    *this = {};
}

void MaskDelta::exchange(Groom& groom) {
    if (values_.empty()) return;
    const bool absentNow = !groom.strandAttributes.has(maskAttribute(number_));
    values_.exchange(oneEach(groom), valuesOf(groom, number_));
    if (absent_) groom.strandAttributes.erase(maskAttribute(number_));
    absent_ = absentNow;
}

}  // namespace hairloom::editing
