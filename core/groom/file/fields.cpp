// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/fields.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {
namespace {

using M = HairMaterial;
using I = InterpolationSettings;
using P = PlacementSettings;

constexpr Field<M> kMaterialFields[] = {
    {"rootRadius", "m", 5e-6, 0.05, "half the fibre's diameter at the root; a hair has 25e-6 to 60e-6",
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
    {"radiusVariation", "", 0, 1, "random spread of the thickness from strand to strand",
     &M::radiusVariation},
    {"gradientStart", "", 0, 1, "share of the length over which hair has the colour of the root",
     &M::gradientStart},
    {"gradientEnd", "", 0, 1, "share of the length from which on it has the colour of the tip",
     &M::gradientEnd},
    {"tipMelanin", "", 0, 8, "pigment at the tip over that at the root: below 1 is bleached", &M::tipMelanin},
    {"melaninVariation", "", 0, 1, "random spread of the pigment, or of the depth of the colour",
     &M::melaninVariation},
    {"dyed", "", 0, 1, "true: Marschner and Sadeghi take the colours too; false: they take the melanin",
     &M::dyed},
    {"streakShare", "", 0, 1, "share of the strands that are in streaks; 0 turns streaks off",
     &M::streakShare},
    {"streakWidth", "m", 0.0005, 0.2, "width of a streak on the scalp", &M::streakWidth},
    {"streakSoftness", "", 0, 1, "0 bounds streaks sharply, 1 lets them fade over their width",
     &M::streakSoftness},
    {"streakDyed", "", 0, 1, "true: streaks have the streak colour; false: they differ in pigment",
     &M::streakDyed},
    {"streakColour", "", 0, 1, "linear red, green and blue of dyed streaks", &M::streakColour},
    {"streakMelanin", "", 0, 8, "pigment in streaks over that beside them: below 1 is bleached",
     &M::streakMelanin},
    {"streakSeed", "", 0, kLargestSeed, "another seed puts streaks in other places", &M::streakSeed},
    {"dyeStrength", "", 0, 1, "share of the dye's colour where the mask is 1; 0 turns dye off",
     &M::dyeStrength},
    {"dyeColour", "", 0, 1, "linear red, green and blue of the dye", &M::dyeColour},
    {"dyeStart", "", 0, 1, "share of the length at which dye begins: dipped tips have 0.6", &M::dyeStart},
    {"dyeEnd", "", 0, 1, "share of the length from which on dye has its full strength", &M::dyeEnd},
    {"eccentricity", "", 0, 0.95, "of the fibre's cross-section: 0 is round (Marschner)", &M::eccentricity},
    {"rIntensity", "", 0, 10, "factor on the first highlight (R)", &M::rIntensity},
    {"ttIntensity", "", 0, 10, "factor on light that shines through (TT)", &M::ttIntensity},
    {"trtIntensity", "", 0, 10, "factor on the second highlight (TRT)", &M::trtIntensity},
    {"rWidth", "", 0.1, 10, "factor on the width along the hair of the first highlight (R)", &M::rWidth},
    {"ttWidth", "", 0.1, 10, "factor on the width along the hair of light that shines through (TT)",
     &M::ttWidth},
    {"trtWidth", "", 0.1, 10, "factor on the width along the hair of the second highlight (TRT)",
     &M::trtWidth},
    {"rShiftDegrees", "°", -30, 30, "moves the first highlight (R) along the hair, towards the tip",
     &M::rShiftDegrees},
    {"ttShiftDegrees", "°", -30, 30, "moves light that shines through (TT) along the hair, towards the tip",
     &M::ttShiftDegrees},
    {"trtShiftDegrees", "°", -30, 30, "moves the second highlight (TRT) along the hair, towards the tip",
     &M::trtShiftDegrees},
    {"rColour", "", 0, 1, "linear factor on the colour of the first highlight (R) (Sadeghi)", &M::rColour},
    {"ttColour", "", 0, 1, "linear factor on the colour of light that shines through (TT) (Sadeghi)",
     &M::ttColour},
    {"trtColour", "", 0, 1, "linear factor on the colour of the second highlight (TRT) (Sadeghi)",
     &M::trtColour},
    {"ttAzimuthalWidth", "", 0.1, 10, "factor on the width around the hair of TT (Sadeghi)",
     &M::ttAzimuthalWidth},
    {"glintIntensity", "", 0, 20, "factor on the glints beside the second highlight (Sadeghi)",
     &M::glintIntensity},
    {"glintWidthDegrees", "°", 1, 90, "width of glints around the hair (Sadeghi)", &M::glintWidthDegrees},
    {"glintNearDegrees", "°", 0, 180, "least angle of a strand's glints, which is random (Sadeghi)",
     &M::glintNearDegrees},
    {"glintFarDegrees", "°", 0, 180, "largest angle of a strand's glints (Sadeghi)", &M::glintFarDegrees},
    {"tubes", "", 0, 1, "true draws strands as round tubes with skin, as tentacles have", &M::tubes},
    {"rootOpacity", "", 0, 1, "how opaque hair is at the root", &M::rootOpacity},
    {"tipOpacity", "", 0, 1, "how opaque hair is at the tip: lower fades out", &M::tipOpacity},
    {"emission", "", 0, 1000, "light that hair gives off by itself, as fire does; 0 is none", &M::emission},
    {"emissionRootColour", "", 0, 1, "linear red, green and blue of that light at the root",
     &M::emissionRootColour},
    {"emissionTipColour", "", 0, 1, "linear red, green and blue of that light at the tip",
     &M::emissionTipColour},
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
