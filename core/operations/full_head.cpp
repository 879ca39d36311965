// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/full_head.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/geometry/placement.h"
#include "core/groom/file/fields.h"
#include "core/operations/head_places.h"

namespace hairloom {
namespace {

/// Where nobody chose another size.
template <class S>
void fitDefault(S& settings, std::string_view name, float scale) {
    const auto fields = fieldsOf(settings);
    const auto field = std::ranges::find(fields, name, [](const auto& one) { return one.name; });
    if (field->get(settings, 0) == field->get(S{}, 0)) fitToHead(settings, *field, scale);
}

}  // namespace

Status fillHead(Groom& groom) {
    const std::size_t guides = groom.guideCount();
    if (guides == 0) return fail("there are no strands to fill between", "place hair first");
    if (!groom.scalp || groom.scalpSelection.empty())
        return fail("no scalp is selected, so nobody knows where hair grows", "select the scalp first");
    const float scale = headScale(groom);
    InterpolationSettings& follow = groom.interpolation;
    follow.followPerGuide = followHairsToFill(groom, guides);
    follow.blend = 1;
    fitDefault(follow, "wispRadiusRoot", scale);
    fitDefault(follow, "wispRadiusTip", scale);
    fitDefault(groom.material, "rootRadius", scale);
    return {};
}

std::uint32_t followHairsToFill(const Groom& groom, std::size_t guides) {
    const double scale{headScale(groom)};
    const double area_cm2 = 1e4 * maskedArea(*groom.scalp, groom.scalpSelection, groom.scalpDensity);
    const double each = kHairsPerCm2 * area_cm2 / (scale * scale) / static_cast<double>(guides);
    const double most = runtime::findField<InterpolationSettings>("followPerGuide")->max;
    return static_cast<std::uint32_t>(std::clamp(std::round(each), 1.0, most));
}

bool isFilledByItself(const Groom& groom) {
    const InterpolationSettings& now = groom.interpolation;
    if (groom.strandCount() == 0) return now.followPerGuide == InterpolationSettings().followPerGuide;
    Groom full = groom;
    return fillHead(full) && full.interpolation.followPerGuide == now.followPerGuide &&
           full.interpolation.blend == now.blend;
}

}  // namespace hairloom
