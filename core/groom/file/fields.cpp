// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/fields.h"

#include <fmt/format.h>

namespace hairloom {
namespace {

using M = HairMaterial;
using I = InterpolationSettings;
using P = PlacementSettings;

constexpr const char* kShadingModels[] = {"kajiya", "marschner", "sadeghi"};
constexpr const char* kColourSources[] = {"melanin", "colours"};
constexpr const char* kEnergyRules[] = {"bounded", "published"};
constexpr const char* kPlacementMethods[] = {"random", "poissonDisk"};

// clang-format off
constexpr Field<M> kMaterialFields[] = {
    choiceField<&M::shadingModel>("shadingModel", "how light scatters in a fibre: kajiya, two highlights of a thread, fast; marschner, glass with pigment, as measured; sadeghi, its lobes as controls of their own", kShadingModels),
    field<&M::rootRadius>("rootRadius", "m", 5e-6, 0.05, "half the fibre's diameter at the root; a hair has 25e-6 to 60e-6"),
    field<&M::tipScale>("tipScale", "", 0, 1, "radius at the tip over radius at the root: lower is more pointed"),
    colourField<&M::rootColour>("rootColour", "linear red, green and blue at the root"),
    colourField<&M::tipColour>("tipColour", "linear red, green and blue at the tip"),
    field<&M::colourVariation>("colourVariation", "", 0, 1, "random spread of brightness from strand to strand"),
    field<&M::specular>("specular", "", 0, 2, "weight of the highlight (Kajiya-Kay)"),
    field<&M::shininess>("shininess", "", 1, 1000, "Kajiya-Kay exponent: higher is a narrower highlight"),
    field<&M::eumelanin>("eumelanin", "", 0, 8, "concentration of the brown-black pigment"),
    field<&M::pheomelanin>("pheomelanin", "", 0, 8, "concentration of the red-yellow pigment"),
    field<&M::indexOfRefraction>("indexOfRefraction", "", 1, 2.5, "how strongly the fibre bends light; hair has 1.55"),
    field<&M::longitudinalRoughness>("longitudinalRoughness", "", 0.01, 1, "width of the highlights along the fibre"),
    field<&M::azimuthalRoughness>("azimuthalRoughness", "", 0.01, 1, "width of the highlights around the fibre"),
    field<&M::scaleTiltDegrees>("scaleTiltDegrees", "°", -10, 10, "tilt of the cuticle's scales towards the root; moves the highlights"),
    field<&M::radiusVariation>("radiusVariation", "", 0, 1, "random spread of the thickness from strand to strand"),
    field<&M::gradientStart>("gradientStart", "", 0, 1, "share of the length over which hair has the colour of the root"),
    field<&M::gradientEnd>("gradientEnd", "", 0, 1, "share of the length from which on it has the colour of the tip"),
    field<&M::tipMelanin>("tipMelanin", "", 0, 8, "pigment at the tip over that at the root: below 1 is bleached"),
    field<&M::melaninVariation>("melaninVariation", "", 0, 1, "random spread of the pigment, or of the depth of the colour"),
    choiceField<&M::colourSource>("colourSource", "what colours Marschner and Sadeghi's hair: the melanin, or the colours above as dye", kColourSources),
    field<&M::streakShare>("streakShare", "", 0, 1, "share of the strands that are in streaks; 0 turns streaks off"),
    field<&M::streakWidth>("streakWidth", "m", 0.0005, 0.2, "width of a streak on the scalp"),
    field<&M::streakSoftness>("streakSoftness", "", 0, 1, "0 bounds streaks sharply, 1 lets them fade over their width"),
    choiceField<&M::streakColourSource>("streakColourSource", "what colours streaks: other melanin, or the streak colour as dye", kColourSources),
    colourField<&M::streakColour>("streakColour", "linear red, green and blue of dyed streaks"),
    field<&M::streakMelanin>("streakMelanin", "", 0, 8, "pigment in streaks over that beside them: below 1 is bleached"),
    seedField<&M::streakSeed>("streakSeed", "another seed puts streaks in other places"),
    field<&M::dyeStrength>("dyeStrength", "", 0, 1, "share of the dye's colour where the mask is 1; 0 turns dye off"),
    colourField<&M::dyeColour>("dyeColour", "linear red, green and blue of the dye"),
    field<&M::dyeStart>("dyeStart", "", 0, 1, "share of the length at which dye begins: dipped tips have 0.6"),
    field<&M::dyeEnd>("dyeEnd", "", 0, 1, "share of the length from which on dye has its full strength"),
    field<&M::eccentricity>("eccentricity", "", 0, 0.95, "of the fibre's cross-section: 0 is round (Marschner)"),
    field<&M::rIntensity>("rIntensity", "", 0, 10, "factor on the first highlight (R)"),
    field<&M::ttIntensity>("ttIntensity", "", 0, 10, "factor on light that shines through (TT)"),
    field<&M::trtIntensity>("trtIntensity", "", 0, 10, "factor on the second highlight (TRT)"),
    field<&M::rWidth>("rWidth", "", 0.1, 10, "factor on the width along the hair of the first highlight (R)"),
    field<&M::ttWidth>("ttWidth", "", 0.1, 10, "factor on the width along the hair of light that shines through (TT)"),
    field<&M::trtWidth>("trtWidth", "", 0.1, 10, "factor on the width along the hair of the second highlight (TRT)"),
    field<&M::rShiftDegrees>("rShiftDegrees", "°", -30, 30, "moves the first highlight (R) along the hair, towards the tip"),
    field<&M::ttShiftDegrees>("ttShiftDegrees", "°", -30, 30, "moves light that shines through (TT) along the hair, towards the tip"),
    field<&M::trtShiftDegrees>("trtShiftDegrees", "°", -30, 30, "moves the second highlight (TRT) along the hair, towards the tip"),
    colourField<&M::rColour>("rColour", "linear factor on the colour of the first highlight (R) (Sadeghi)"),
    colourField<&M::ttColour>("ttColour", "linear factor on the colour of light that shines through (TT) (Sadeghi)"),
    colourField<&M::trtColour>("trtColour", "linear factor on the colour of the second highlight (TRT) (Sadeghi)"),
    field<&M::ttAzimuthalWidth>("ttAzimuthalWidth", "", 0.1, 10, "factor on the width around the hair of TT (Sadeghi)"),
    field<&M::glintIntensity>("glintIntensity", "", 0, 20, "factor on the glints beside the second highlight (Sadeghi)"),
    field<&M::glintWidthDegrees>("glintWidthDegrees", "°", 1, 90, "width of glints around the hair (Sadeghi)"),
    field<&M::glintNearDegrees>("glintNearDegrees", "°", 0, 180, "least angle of a strand's glints, which is random (Sadeghi)"),
    field<&M::glintFarDegrees>("glintFarDegrees", "°", 0, 180, "largest angle of a strand's glints (Sadeghi)"),
    choiceField<&M::energy>("energy", "bounded: hair of Kajiya-Kay and Sadeghi sends out no more light than it gets; published: as their authors have it, bright hair up to three times as much", kEnergyRules),
    boolField<&M::tubes>("tubes", "true draws strands as round tubes with skin, as tentacles have"),
    field<&M::rootOpacity>("rootOpacity", "", 0, 1, "how opaque hair is at the root"),
    field<&M::tipOpacity>("tipOpacity", "", 0, 1, "how opaque hair is at the tip: lower fades out"),
    field<&M::emission>("emission", "", 0, 1000, "light that hair gives off by itself, as fire does; 0 is none"),
    colourField<&M::emissionRootColour>("emissionRootColour", "linear red, green and blue of that light at the root"),
    colourField<&M::emissionTipColour>("emissionTipColour", "linear red, green and blue of that light at the tip"),
};

constexpr Field<I> kInterpolationFields[] = {
    field<&I::followPerGuide>("followPerGuide", "", 0, 4096, "follow hairs for each guide; 0 shows the strands themselves"),
    field<&I::wispRadiusRoot>("wispRadiusRoot", "m", 0, 0.1, "radius of a wisp's cross-section at the root"),
    field<&I::wispRadiusTip>("wispRadiusTip", "m", 0, 0.1, "radius of a wisp's cross-section at the tip"),
    field<&I::blend>("blend", "", 0, 1, "0 follows one strand in wisps, 1 the three strands of a root triangle"),
    seedField<&I::seed>("seed", "another seed gives other follow hairs"),
};

constexpr Field<P> kPlacementFields[] = {
    choiceField<&P::placement>("placement", "how roots are placed: at random, or at even distances (Poisson disk, by dart throwing)", kPlacementMethods),
    field<&P::count>("count", "", 1, 5e6, "number of roots; used while densityPerCm2 is 0"),
    field<&P::densityPerCm2>("densityPerCm2", "1/cm²", 0, 10000, "roots per area where the density map is 1; 0 uses the count"),
    field<&P::length>("length", "m", 0.0001, 10, "length of the strands that grow"),
    field<&P::points>("points", "", 2, 1024, "points of a strand: more bend more finely and cost more"),
    seedField<&P::seed>("seed", "another seed places other roots"),
};

// clang-format on

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
    return FieldInfo{"", "", min, max, "", FieldKind::Float}.holds(value);
}

std::vector<std::string> sentences(const std::vector<runtime::FieldProblem>& problems) {
    std::vector<std::string> sentences;
    for (const runtime::FieldProblem& problem : problems) {
        const FieldInfo& field = *problem.field;
        sentences.push_back(fmt::format("{} {}", problem.where(),
                                        problem.ramp.empty()
                                            ? outOfRangeText(problem.value, field.min, field.max, field.unit)
                                            : problem.ramp));
    }
    return sentences;
}

}  // namespace hairloom
