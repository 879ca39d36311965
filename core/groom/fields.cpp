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
    {"shadingModel", "", 0, 2, "0 Kajiya-Kay, 1 Marschner, 2 Sadeghi: what the editor shows the hair with",
     &M::shadingModel},
    {"diffuse", "", 0, 1, "light that a fibre scatters everywhere (Kajiya-Kay)", &M::diffuse},
    {"secondSpecular", "", 0, 4, "factor on the second, coloured highlight (Kajiya-Kay)", &M::secondSpecular},
    {"scattering", "", 0, 1, "light that other fibres pass on (Kajiya-Kay)", &M::scattering},
    {"eccentricity", "", 0, 0.95, "of the fibre's cross-section: 0 is round, 0.9 flat; moves the glints",
     &M::eccentricity},
    {"rIntensity", "", 0, 4, "factor on the light that the fibre's surface reflects", &M::rIntensity},
    {"ttIntensity", "", 0, 4, "factor on the light that shines through the fibre", &M::ttIntensity},
    {"trtIntensity", "", 0, 4, "factor on the coloured highlight, reflected at the back of the fibre",
     &M::trtIntensity},
    {"rWidth", "", 0.2, 4, "factor on the width of the surface's highlight along the fibre", &M::rWidth},
    {"ttWidth", "", 0.2, 4, "factor on the width along the fibre of what shines through", &M::ttWidth},
    {"trtWidth", "", 0.2, 4, "factor on the width of the coloured highlight along the fibre", &M::trtWidth},
    {"rShift", "°", -15, 15, "moves the surface's highlight towards the tip", &M::rShift},
    {"ttShift", "°", -15, 15, "moves what shines through towards the tip", &M::ttShift},
    {"trtShift", "°", -15, 15, "moves the coloured highlight towards the tip", &M::trtShift},
    {"glintIntensity", "", 0, 4, "factor on the glints; Marschner's need a smooth fibre", &M::glintIntensity},
    {"glintWidth", "", 0.2, 4, "factor on the width of the glints; Marschner's need a smooth fibre",
     &M::glintWidth},
    {"causticFade", "", 0.01, 1, "how softly caustics end as light slants; of a smooth fibre (Marschner)",
     &M::causticFade},
    {"ttSpread", "", 0.2, 4, "factor on the width around the fibre of what shines through (Sadeghi)",
     &M::ttSpread},
    {"glintNearDegrees", "°", 0, 90, "least angle around the fibre at which strands glint (Sadeghi)",
     &M::glintNearDegrees},
    {"glintFarDegrees", "°", 0, 90, "greatest angle around the fibre at which strands glint (Sadeghi)",
     &M::glintFarDegrees},
    {"rTint", "", 0, 1, "factor on the colour of the surface's highlight (Sadeghi)", &M::rTint},
    {"ttTint", "", 0, 1, "factor on the colour of what shines through (Sadeghi)", &M::ttTint},
    {"trtTint", "", 0, 1, "factor on the colour of the coloured highlight (Sadeghi)", &M::trtTint},
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
