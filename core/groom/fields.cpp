// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/fields.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {
namespace {

using M = HairMaterial;
using I = InterpolationSettings;
using P = PlacementSettings;

constexpr Field<M> kMaterialFields[] = {
    {"rootRadius", "m", 5e-6, 0.005, "half the fibre's diameter at the root; a hair has 25e-6 to 60e-6",
     &M::rootRadius},
    {"tipScale", "", 0, 1, "radius at the tip over radius at the root: lower is more pointed", &M::tipScale},
    {"rootColour", "", 0, 1, "linear red, green and blue at the root", &M::rootColour},
    {"tipColour", "", 0, 1, "linear red, green and blue at the tip", &M::tipColour},
    {"colourVariation", "", 0, 1, "random spread of brightness from strand to strand", &M::colourVariation},
    {"specular", "", 0, 2, "weight of the highlight (Kajiya-Kay)", &M::specular},
    {"shininess", "", 1, 1000, "Kajiya-Kay exponent: higher is a narrower highlight", &M::shininess},
    {"eumelanin", "", 0, 8, "concentration of the brown-black pigment", &M::eumelanin},
    {"pheomelanin", "", 0, 8, "concentration of the red-yellow pigment", &M::pheomelanin},
    {"indexOfRefraction", "", 1, 2.5, "how strongly the fibre bends light; hair has 1.55",
     &M::indexOfRefraction},
    {"longitudinalRoughness", "", 0.01, 1, "width of the highlights along the fibre",
     &M::longitudinalRoughness},
    {"azimuthalRoughness", "", 0.01, 1, "width of the highlights around the fibre", &M::azimuthalRoughness},
    {"scaleTiltDegrees", "°", -10, 10, "tilt of the cuticle's scales towards the root; moves the highlights",
     &M::scaleTiltDegrees},
};

constexpr Field<I> kInterpolationFields[] = {
    {"followPerGuide", "", 0, 4096, "follow hairs for each guide; 0 shows the strands themselves",
     &I::followPerGuide},
    {"wispRadiusRoot", "m", 0, 0.1, "radius of a wisp's cross-section at the root", &I::wispRadiusRoot},
    {"wispRadiusTip", "m", 0, 0.1, "radius of a wisp's cross-section at the tip", &I::wispRadiusTip},
    {"blend", "", 0, 1, "0 follows one strand in wisps, 1 the three strands of a root triangle", &I::blend},
    {"seed", "", 0, kLargestSeed, "another seed gives other follow hairs", &I::seed},
};

constexpr Field<P> kPlacementFields[] = {
    {"darts", "", 0, 1, "true places roots at even distances, false at random", &P::darts},
    {"count", "", 1, 5e6, "number of roots; used while densityPerCm2 is 0", &P::count},
    {"densityPerCm2", "1/cm²", 0, 10000, "roots per area where the density map is 1; 0 uses the count",
     &P::densityPerCm2},
    {"length", "m", 0.0001, 10, "length of the strands that grow", &P::length},
    {"points", "", 2, 1024, "points of a strand: more bend more finely and cost more", &P::points},
    {"seed", "", 0, kLargestSeed, "another seed places other roots", &P::seed},
};

}  // namespace

std::span<const Field<HairMaterial>> fieldsOf(const HairMaterial&) {
    return kMaterialFields;
}
std::span<const Field<InterpolationSettings>> fieldsOf(const InterpolationSettings&) {
    return kInterpolationFields;
}
std::span<const Field<PlacementSettings>> fieldsOf(const PlacementSettings&) {
    return kPlacementFields;
}

std::string rangeText(double min, double max, std::string_view unit) {
    return fmt::format("{} to {}{}{}", min, max, unit.empty() ? "" : " ", unit);
}

std::string outOfRangeText(double value, double min, double max, std::string_view unit) {
    return fmt::format("is {}; expected {}", value, rangeText(min, max, unit));
}

bool withinRange(double value, double min, double max) {
    return value >= std::min(min, static_cast<double>(static_cast<float>(min))) &&
           value <= std::max(max, static_cast<double>(static_cast<float>(max)));
}

}  // namespace hairloom
