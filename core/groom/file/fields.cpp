// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/fields.h"

#include <fmt/format.h>

namespace hairloom {
namespace {

using M = HairMaterial;
using I = InterpolationSettings;
using P = PlacementSettings;
using S = ShadowSettings;

constexpr const char* kShadingModels[] = {"kajiya", "marschner", "sadeghi"};
constexpr const char* kColourSources[] = {"melanin", "colours"};
constexpr const char* kEnergyRules[] = {"bounded", "published"};
constexpr const char* kAzimuthalSolvers[] = {"exact", "cubic"};
constexpr const char* kShadowKinds[] = {"deepOpacity", "absorption", "opacityMaps", "adaptive", "none"};
constexpr const char* kShadowFilters[] = {"off", "3x3", "5x5"};
constexpr const char* kLayerEnds[] = {"early", "linear", "growing"};
constexpr const char* kPlacementMethods[] = {"random", "poissonDisk"};

// clang-format off
constexpr Field<M> kMaterialFields[] = {
    choiceField<&M::shadingModel>("shadingModel", "shading model: kajiya, two highlights, fast; marschner, physically based melanin fibre; sadeghi, Marschner's lobes with art-directable controls", kShadingModels),
    field<&M::rootRadius>("rootRadius", "m", 5e-6, 0.05, "radius of the fibre at the root: real hair has 25e-6 to 60e-6"),
    field<&M::tipScale>("tipScale", "", 0, 1, "ratio of the tip radius to the root radius: lower is more pointed"),
    colourField<&M::rootColour>("rootColour", "linear RGB at the root"),
    colourField<&M::tipColour>("tipColour", "linear RGB at the tip"),
    field<&M::colourVariation>("colourVariation", "", 0, 1, "random variation of brightness between strands"),
    field<&M::specular>("specular", "", 0, 2, "strength of the highlight (Kajiya-Kay)"),
    field<&M::shininess>("shininess", "", 1, 1000, "Kajiya-Kay exponent: higher gives a narrower highlight"),
    field<&M::eumelanin>("eumelanin", "", 0, 8, "concentration of the brown-black pigment"),
    field<&M::pheomelanin>("pheomelanin", "", 0, 8, "concentration of the red-yellow pigment"),
    field<&M::indexOfRefraction>("indexOfRefraction", "", 1, 2.5, "index of refraction: hair has 1.55"),
    field<&M::longitudinalRoughness>("longitudinalRoughness", "", 0.01, 1, "longitudinal roughness: width of the highlights along the fibre"),
    field<&M::azimuthalRoughness>("azimuthalRoughness", "", 0.01, 1, "azimuthal roughness: width of the highlights around the fibre"),
    field<&M::scaleTiltDegrees>("scaleTiltDegrees", "°", -10, 10, "tilt of the cuticle scales: moves the highlights towards the root"),
    field<&M::radiusVariation>("radiusVariation", "", 0, 1, "random variation of thickness between strands"),
    field<&M::gradientStart>("gradientStart", "", 0, 1, "share of the length that has the root colour"),
    field<&M::gradientEnd>("gradientEnd", "", 0, 1, "share of the length from which hair has the tip colour"),
    field<&M::tipMelanin>("tipMelanin", "", 0, 8, "ratio of pigment at the tip to pigment at the root: below 1 is bleached"),
    field<&M::melaninVariation>("melaninVariation", "", 0, 1, "random variation of pigment or of colour depth between strands"),
    choiceField<&M::colourSource>("colourSource", "where Marschner and Sadeghi hair gets its colour: melanin, or the colours above as dye", kColourSources),
    field<&M::streakShare>("streakShare", "", 0, 1, "share of strands in streaks: 0 turns streaks off"),
    field<&M::streakWidth>("streakWidth", "m", 0.0005, 0.2, "width of a streak on the scalp"),
    field<&M::streakSoftness>("streakSoftness", "", 0, 1, "edge softness of streaks: 0 is sharp, 1 fades over the whole width"),
    choiceField<&M::streakColourSource>("streakColourSource", "what colours streaks: a different melanin, or the streak colour as dye", kColourSources),
    colourField<&M::streakColour>("streakColour", "linear RGB of dyed streaks"),
    field<&M::streakMelanin>("streakMelanin", "", 0, 8, "ratio of pigment in streaks to pigment beside them: below 1 is bleached"),
    seedField<&M::streakSeed>("streakSeed", "random seed of the streaks"),
    field<&M::greyShare>("greyShare", "", 0, 1, "share of strands that are white: 0.5 is salt and pepper"),
    seedField<&M::greySeed>("greySeed", "random seed of the white strands"),
    field<&M::dyeStrength>("dyeStrength", "", 0, 1, "strength of the dye where the mask is 1: 0 turns dye off"),
    colourField<&M::dyeColour>("dyeColour", "linear RGB of the dye"),
    field<&M::dyeStart>("dyeStart", "", 0, 1, "share of the length where dye begins: 0.6 dips the tips"),
    field<&M::dyeEnd>("dyeEnd", "", 0, 1, "share of the length from which dye has full strength"),
    field<&M::dyeRegrowth>("dyeRegrowth", "m", 0, 2, "length at the root that has grown since the hair was dyed, and has its natural colour"),
    field<&M::dyeRegrowthSoftness>("dyeRegrowthSoftness", "m", 0, 0.5, "length over which the natural colour fades into the dye"),
    field<&M::eccentricity>("eccentricity", "", 0, 0.95, "eccentricity of the fibre's cross-section: 0 is round. Marschner spreads the second highlight, Sadeghi the glints, and Kajiya-Kay varies the second highlight between strands"),
    field<&M::rIntensity>("rIntensity", "", 0, 10, "strength of the first highlight (R)"),
    field<&M::ttIntensity>("ttIntensity", "", 0, 10, "strength of the transmission (TT)"),
    field<&M::trtIntensity>("trtIntensity", "", 0, 10, "strength of the second highlight (TRT)"),
    field<&M::rWidth>("rWidth", "", 0.1, 10, "scales the longitudinal width of the first highlight (R)"),
    field<&M::ttWidth>("ttWidth", "", 0.1, 10, "scales the longitudinal width of the transmission (TT)"),
    field<&M::trtWidth>("trtWidth", "", 0.1, 10, "scales the longitudinal width of the second highlight (TRT)"),
    field<&M::rShiftDegrees>("rShiftDegrees", "°", -30, 30, "shifts the first highlight (R) along the hair, towards the tip"),
    field<&M::ttShiftDegrees>("ttShiftDegrees", "°", -30, 30, "shifts the transmission (TT) along the hair, towards the tip"),
    field<&M::trtShiftDegrees>("trtShiftDegrees", "°", -30, 30, "shifts the second highlight (TRT) along the hair, towards the tip"),
    colourField<&M::rColour>("rColour", "linear RGB tint of the first highlight (R) (Sadeghi)"),
    colourField<&M::ttColour>("ttColour", "linear RGB tint of the transmission (TT) (Sadeghi)"),
    colourField<&M::trtColour>("trtColour", "linear RGB tint of the second highlight (TRT) (Sadeghi)"),
    field<&M::ttAzimuthalWidth>("ttAzimuthalWidth", "", 0.1, 10, "scales the azimuthal width of TT (Sadeghi)"),
    field<&M::glintIntensity>("glintIntensity", "", 0, 20, "strength of the glints beside the second highlight (Sadeghi)"),
    field<&M::glintWidthDegrees>("glintWidthDegrees", "°", 1, 90, "azimuthal width of the glints (Sadeghi)"),
    field<&M::glintNearDegrees>("glintNearDegrees", "°", 0, 180, "smallest angle of the glints, which varies randomly between strands (Sadeghi)"),
    field<&M::glintFarDegrees>("glintFarDegrees", "°", 0, 180, "largest angle of the glints (Sadeghi)"),
    field<&M::causticWidthDegrees>("causticWidthDegrees", "°", 0, 60, "width of the glints that replace caustics: 0 takes 11.5° for smooth fibres and leaves rough ones as they are (Marschner)"),
    field<&M::causticFade>("causticFade", "", 0, 1, "range of refraction, above the index 2 where caustics end, over which glints fade out (Marschner)"),
    field<&M::causticIntensity>("causticIntensity", "", 0, 10, "strength of the glints that replace caustics, k_G: 1 keeps the energy (Marschner)"),
    choiceField<&M::azimuthalSolver>("azimuthalSolver", "how light's way around the fibre is found: exact, by the true angles; cubic, by Marschner's approximation, which sends up to 4 % of a highlight's light elsewhere (Marschner)", kAzimuthalSolvers),
    choiceField<&M::energy>("energy", "bounded: Kajiya-Kay and Sadeghi hair reflects no more light than it receives; published: the authors' formulas, with bright hair up to three times as bright", kEnergyRules),
    boolField<&M::tubes>("tubes", "draws strands as round tubes with skin, for tentacles"),
    field<&M::rootOpacity>("rootOpacity", "", 0, 1, "opacity at the root"),
    field<&M::tipOpacity>("tipOpacity", "", 0, 1, "opacity at the tip: lower fades out"),
    field<&M::emission>("emission", "", 0, 1000, "emission, as for fire: 0 is none"),
    colourField<&M::emissionRootColour>("emissionRootColour", "linear RGB of the emission at the root"),
    colourField<&M::emissionTipColour>("emissionTipColour", "linear RGB of the emission at the tip"),
};

constexpr Field<I> kInterpolationFields[] = {
    field<&I::followPerGuide>("followPerGuide", "", 0, 4096, "follow hairs per guide: 0 shows only the strands themselves"),
    field<&I::wispRadiusRoot>("wispRadiusRoot", "m", 0, 0.1, "radius of a wisp at the root"),
    field<&I::wispRadiusTip>("wispRadiusTip", "m", 0, 0.1, "radius of a wisp at the tip"),
    field<&I::wispSpread>("wispSpread", "s/m", 0, 10, "how much a wisp widens with speed at the tip, per m/s, and less towards the root: 0 keeps its width"),
    field<&I::wispSpreadLimit>("wispSpreadLimit", "", 1, 100, "greatest factor by which speed widens a wisp"),
    field<&I::blend>("blend", "", 0, 1, "0 follows one guide in wisps, 1 interpolates the three guides of a root triangle"),
    boolField<&I::drawGuides>("drawGuides", "one of the follow hairs of each guide is the guide itself"),
    seedField<&I::seed>("seed", "random seed of the follow hairs"),
};

constexpr Field<S> kShadowFields[] = {
    choiceField<&S::kind>("kind", "how hair shadows hair: deepOpacity, layers behind the first hair; absorption, depth behind the first hair alone; opacityMaps, slices at fixed depths; adaptive, a curve of the light in each texel, with nodes where it changes most; none", kShadowKinds),
    choiceField<&S::filter>("filter", "texels of the shadow map that are averaged at each point of the hair: more give smoother shadows", kShadowFilters),
    field<&S::resolution>("resolution", "px", 64, 4096, "width and height of a light's shadow map"),
    field<&S::layers>("layers", "", 3, 11, "layers of deep opacity maps"),
    choiceField<&S::layerEnds>("layerEnds", "where layers end: early, most of them where hair begins; linear, evenly; growing, each as much wider as layerGrowth says", kLayerEnds),
    field<&S::layerGrowth>("layerGrowth", "", 1, 8, "ratio of the width of a layer to that of the layer before, for growing ends"),
    field<&S::slices>("slices", "", 1, 16, "slices of opacity maps, evenly spaced"),
    field<&S::nodes>("nodes", "", 4, 16, "nodes of a texel's curve in adaptive shadow maps"),
    field<&S::headAbsorption>("headAbsorption", "1/m", 0, 10'000, "light on hair behind the head fades with depth, by this much per metre: 0 blocks all of it"),
    field<&S::blur>("blur", "px", 0, 32, "blurs shadows in the image by this standard deviation: 0 turns it off"),
};

constexpr Field<P> kPlacementFields[] = {
    choiceField<&P::placement>("placement", "how roots are placed: at random, or evenly spaced (Poisson disk, by dart throwing)", kPlacementMethods),
    field<&P::count>("count", "", 1, 5e6, "number of roots, used while densityPerCm2 is 0"),
    field<&P::densityPerCm2>("densityPerCm2", "1/cm²", 0, 10000, "roots per area where the density map is 1: 0 uses the count"),
    field<&P::length>("length", "m", 0.0001, 10, "length of new strands"),
    field<&P::points>("points", "", 2, 1024, "points per strand: more bend more finely and cost more"),
    seedField<&P::seed>("seed", "random seed of the root positions"),
};

// clang-format on

}  // namespace

std::span<const Field<HairMaterial>> fieldsOf(const HairMaterial&) {
    return kMaterialFields;
}
std::span<const Field<InterpolationSettings>> fieldsOf(const InterpolationSettings&) {
    return kInterpolationFields;
}
std::span<const Field<ShadowSettings>> fieldsOf(const ShadowSettings&) {
    return kShadowFields;
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
