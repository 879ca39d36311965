// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/hair_look.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "core/base/parallel.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "core/groom/strand_subset.h"
#include "core/groom/streaks.h"
#include "core/groom/white_strands.h"

namespace hairloom {
namespace {

using shading::LookQuantity;

constexpr double kMinLobeWidth = 0.5 * shading::kDegree;  // in θ_h
constexpr double kLargestLobeWidth = 60 * shading::kDegree;

double asDouble(float value) {
    return static_cast<double>(value);
}

double roughnessOf(const HairMaterial& authored, const FibreView& view) {
    return view.azimuthalRoughness.value_or(asDouble(authored.azimuthalRoughness));
}

double axisRatioOf(const HairMaterial& authored, const FibreView& view) {
    return view.axisRatio.value_or(shading::axisRatio(asDouble(authored.eccentricity)));
}

Vec3d melaninAbsorption(const HairMaterial& authored, double factor) {
    return factor * shading::absorption({asDouble(authored.eumelanin), asDouble(authored.pheomelanin)});
}

/// The colours of Kajiya-Kay.
shading::StrandLook colourLook(const HairMaterial& authored) {
    shading::StrandLook look;
    look.quantity = LookQuantity::colour;
    look.root = authored.rootColour.cast<double>();
    look.tip = authored.tipColour.cast<double>();
    if (authored.streakColourSource == ColourSource::colours) {
        look.streakRoot = look.streakTip = authored.streakColour.cast<double>();
    } else {
        const double factor = asDouble(authored.streakMelanin);
        look.streakRoot = shading::colourOfMoreAbsorption(look.root, factor);
        look.streakTip = shading::colourOfMoreAbsorption(look.tip, factor);
    }
    look.dye = authored.dyeColour.cast<double>();
    return look;
}

/// What fibres absorb.
shading::StrandLook absorptionLook(const HairMaterial& authored, double roughness) {
    shading::StrandLook look;
    look.quantity = LookQuantity::absorption;
    look.ownScale = shading::absorptionScale(roughness);
    const auto ofColour = [&](const Vec3f& colour) {
        return shading::absorptionOfColour(colour.cast<double>(), roughness);
    };
    const bool dyed = authored.colourSource == ColourSource::colours;
    look.root = dyed ? ofColour(authored.rootColour) : melaninAbsorption(authored, 1);
    look.tip =
        dyed ? ofColour(authored.tipColour) : melaninAbsorption(authored, asDouble(authored.tipMelanin));
    if (authored.streakColourSource == ColourSource::colours) {
        look.streakRoot = look.streakTip = ofColour(authored.streakColour);
    } else {
        look.streakRoot = asDouble(authored.streakMelanin) * look.root;
        look.streakTip = asDouble(authored.streakMelanin) * look.tip;
    }
    look.dye = ofColour(authored.dyeColour);
    return look;
}

/// The highlights of an authored material against those of its fibre: R, TT, TRT.
struct LobeControls {
    std::array<double, 3> intensity, width, shift;

    explicit LobeControls(const HairMaterial& m)
        : intensity{asDouble(m.rIntensity), asDouble(m.ttIntensity), asDouble(m.trtIntensity)},
          width{asDouble(m.rWidth), asDouble(m.ttWidth), asDouble(m.trtWidth)},
          shift{asDouble(m.rShiftDegrees) * shading::kDegree, asDouble(m.ttShiftDegrees) * shading::kDegree,
                asDouble(m.trtShiftDegrees) * shading::kDegree} {}

    void applyTo(shading::MarschnerParameters& m) const {
        for (std::size_t p = 0; p < 3; ++p) {
            m.intensity[p] *= intensity[p];
            m.width[p] = std::clamp(m.width[p] * width[p], kMinLobeWidth, kLargestLobeWidth);
            m.tilt[p] += shift[p];
        }
    }
    /// Lobes keep their height when they get wider: that is the model's intention.
    void applyTo(shading::SadeghiParameters& s) const {
        std::size_t p = 0;
        for (shading::SadeghiLobe* lobe : {&s.r, &s.tt, &s.trt}) {
            lobe->intensity *= intensity[p];
            lobe->width *= width[p];
            lobe->shift += shift[p];
            ++p;
        }
    }
};

/// What of Marschner's fibres alone is authored.
void setCaustics(const HairMaterial& authored, const FibreView& view, shading::AzimuthalParameters& fibre) {
    const double width =
        view.causticWidth.value_or(asDouble(authored.causticWidthDegrees) * shading::kDegree);
    if (width > 0) fibre.causticWidth = width;
    fibre.causticFade = view.causticFade.value_or(asDouble(authored.causticFade));
    fibre.glint = view.causticIntensity.value_or(asDouble(authored.causticIntensity));
    const bool isCubic = view.azimuthalSolver.value_or(authored.azimuthalSolver) == AzimuthalSolver::cubic;
    fibre.roots = isCubic ? shading::RootMethod::Cubic : shading::RootMethod::Exact;
}

/// What Sadeghi's lobes have that Marschner's have not.
void paintLobes(const HairMaterial& authored, double ior, double axisRatio, shading::SadeghiParameters& s) {
    s.r.tint = authored.rColour.cast<double>();
    s.tt.tint = authored.ttColour.cast<double>();
    s.trt.tint = authored.trtColour.cast<double>();
    s.ttAzimuthalWidth *= asDouble(authored.ttAzimuthalWidth);
    s.glintIntensity *= asDouble(authored.glintIntensity);
    s.glintWidth = asDouble(authored.glintWidthDegrees) * shading::kDegree;
    s.glintNear = asDouble(authored.glintNearDegrees) * shading::kDegree;
    s.glintFar = asDouble(authored.glintFarDegrees) * shading::kDegree;
    if (axisRatio == 1) return;
    // An elliptic fibre glints where its caustics are, another one as it turns.
    const shading::CausticAzimuths caustics = shading::causticAzimuths(ior, axisRatio);
    s.glintNear = std::max(s.glintNear + caustics.least - caustics.round, 0.0);
    s.glintFar = std::min(s.glintFar + caustics.greatest - caustics.round, std::numbers::pi);
}

bool isEven(const HairMaterial& authored, const shading::StrandLook& look, const OwnOfStrands& own) {
    const bool sameEnds = look.root == look.tip;
    const bool ownMatter = own.melanin || (own.colours && look.quantity == LookQuantity::absorption);
    return sameEnds && !ownMatter && authored.streakShare <= 0 && authored.dyeStrength <= 0 &&
           authored.greyShare <= 0 && authored.melaninVariation <= 0 && authored.emission <= 0;
}

void finishLook(const HairMaterial& authored, shading::StrandLook& look) {
    look.gradient =
        shading::LinearStep::between(asDouble(authored.gradientStart), asDouble(authored.gradientEnd));
    look.dyeAlong = shading::LinearStep::between(asDouble(authored.dyeStart), asDouble(authored.dyeEnd));
    if (authored.dyeRegrowth > 0) {
        const double half = 0.5 * asDouble(authored.dyeRegrowthSoftness);
        look.regrowth = shading::LinearStep::between(asDouble(authored.dyeRegrowth) - half,
                                                     asDouble(authored.dyeRegrowth) + half);
    }
    look.streakPigment = authored.streakColourSource == ColourSource::melanin ? 1 : 0;
    look.spread = asDouble(authored.melaninVariation);
    look.emissionRoot = asDouble(authored.emission) * authored.emissionRootColour.cast<double>();
    look.emissionTip = asDouble(authored.emission) * authored.emissionTipColour.cast<double>();
}

std::vector<Vec3f> rootsOf(const Groom& groom) {
    std::vector<Vec3f> roots(groom.strandCount());
    for (std::size_t s = 0; s < roots.size(); ++s) roots[s] = groom.strand(s)[0];
    return roots;
}

bool isPainted(const Groom& groom) {
    return groom.pointAttributes.has(attribute::kPointDye);
}

float maskOf(std::span<const float> mask, std::size_t strand) {
    return mask.empty() ? 1.0f : mask[strand];
}

/// As RenderStrands::materials counts them.
std::vector<const HairMaterial*> authoredMaterials(const Groom& groom) {
    std::vector<const HairMaterial*> materials{&groom.material};
    for (const Layer& layer : groom.layers) {
        if (layer.material) materials.push_back(&*layer.material);
    }
    return materials;
}

/// Which material each strand that is drawn has.
struct Owners {
    std::vector<const HairMaterial*> materials;
    std::vector<std::uint32_t> ofStrands;  ///< empty: all have the first

    const HairMaterial& of(std::size_t strand) const {
        const std::uint32_t which = ofStrands.empty() ? 0 : ofStrands[strand];
        return *materials[which == render::kNotDrawn ? 0 : which];
    }
    bool hasStreaks() const {
        return std::ranges::any_of(materials, [](const auto* m) { return m->streakShare > 0; });
    }
    bool hasWhite() const {
        return std::ranges::any_of(materials, [](const auto* m) { return m->greyShare > 0; });
    }
    bool hasGrownOut() const {
        return std::ranges::any_of(materials,
                                   [](const auto* m) { return m->dyeStrength > 0 && m->dyeRegrowth > 0; });
    }
    bool isDyed() const {
        return std::ranges::any_of(materials, [](const auto* m) { return m->dyeStrength > 0; });
    }
    std::vector<float> streaks(std::span<const Vec3f> roots) const {
        if (ofStrands.empty()) return streakWeights(*materials.front(), roots);
        std::vector<float> weights(roots.size());
        for (std::size_t m = 0; m < materials.size(); ++m) {
            const std::vector<float> own = streakWeights(*materials[m], roots);
            for (std::size_t s = 0; s < own.size(); ++s) {
                if (ofStrands[s] == m) weights[s] = own[s];
            }
        }
        return weights;
    }
};

/// Of the hairs of `rest`, of which `melanin` has one value each or none.
void takePigments(const Owners& owners, const Groom& rest, std::span<const float> melanin,
                  LookWeights& weights) {
    if (!owners.hasWhite() && melanin.empty()) return;
    weights.pigments.resize(rest.strandCount());
    for (std::size_t s = 0; s < weights.pigments.size(); ++s) {
        // Projects and hair files may have any number: what is none counts as that of the material.
        const float own =
            melanin.empty() || std::isnan(melanin[s]) ? 1.0f : std::clamp(melanin[s], 0.0f, kMostMelanin);
        weights.pigments[s] = isWhite(owners.of(s), rest.strand(s)[0]) ? 0.0f : own;
    }
}

/// The length that places the border of the dye where `regrowth` metres of the strand are, of points that may
/// be uneven: places along strands are shares of the number of points. The strand's own where it is shorter.
float lengthAtBorder(std::span<const Vec3f> points, float regrowth) {
    float length = 0;
    for (std::size_t p = 1; p < points.size(); ++p) {
        const float segment = (points[p] - points[p - 1]).norm();
        if (regrowth > 0 && length + segment >= regrowth) {
            const float along = (static_cast<float>(p - 1) + (regrowth - length) / segment) /
                                static_cast<float>(points.size() - 1);
            return regrowth / along;
        }
        length += segment;
    }
    return length;
}

void takeLengths(const Owners& owners, const Groom& rest, LookWeights& weights) {
    if (!owners.hasGrownOut()) return;
    weights.lengths.resize(rest.strandCount());
    for (std::size_t s = 0; s < weights.lengths.size(); ++s)
        weights.lengths[s] = lengthAtBorder(rest.strand(s), owners.of(s).dyeRegrowth);
}

}  // namespace

render::FibreMaterial fibreMaterial(const HairMaterial& authored, const FibreView& view) {
    const double roughness = roughnessOf(authored, view);
    shading::MarschnerParameters m;
    m.azimuthal.ior = view.ior.value_or(asDouble(authored.indexOfRefraction));
    m.azimuthal.absorption = view.absorption ? *view.absorption
                             : view.colour   ? shading::absorptionOfColour(*view.colour, roughness)
                             : view.melanin  ? shading::absorption(*view.melanin)
                                             : absorptionLook(authored, roughness).root;
    m.azimuthal.width = shading::azimuthalWidth(roughness);
    if (m.azimuthal.width >= shading::kMinAzimuthalWidth) m.azimuthal.causticWidth = 0;
    m.azimuthal.axisRatio = axisRatioOf(authored, view);
    shading::setScales(m, asDouble(authored.scaleTiltDegrees) * shading::kDegree,
                       shading::longitudinalWidth(asDouble(authored.longitudinalRoughness)));
    const LobeControls controls(authored);
    const render::ShadingModel model = shadingModel(authored, view);
    if (model == render::ShadingModel::marschner) {
        controls.applyTo(m);
        setCaustics(authored, view, m.azimuthal);
    }
    if (view.width) m.width = *view.width;
    if (view.tilt) m.tilt = *view.tilt;

    render::FibreMaterial fibre;
    fibre.model = model;
    fibre.scattering = view.scattering;
    if (model == render::ShadingModel::marschner) fibre.marschner = m;
    if (model == render::ShadingModel::sadeghi) {
        fibre.sadeghi = sadeghiLike(shading::Marschner(m));
        controls.applyTo(fibre.sadeghi);
        paintLobes(authored, m.azimuthal.ior, m.azimuthal.axisRatio, fibre.sadeghi);
        fibre.sadeghi.bounded = authored.energy == EnergyRule::bounded;
        fibre.marschner = m;
    }
    return fibre;
}

render::StrandShading strandShading(const HairMaterial& authored, const ViewFile& view,
                                    const OwnOfStrands& own) {
    render::StrandShading material;
    material.albedo = authored.tipColour;
    material.rootBrightness = material.tipBrightness = 1;
    material.variation = authored.colourVariation;
    material.radius = view.rootRadius.value_or(authored.rootRadius);
    material.tipScale = view.tipScale.value_or(authored.tipScale);
    material.radiusVariation = authored.radiusVariation;
    material.rootOpacity = authored.rootOpacity;
    material.tipOpacity = authored.tipOpacity;
    // One authored highlight drives both of the shader's: the light's own colour, narrow, and the fibre's,
    // wide.
    material.primary = Vec3f::Constant(0.32f * authored.specular);
    material.primaryExponent = 1.5f * authored.shininess;
    material.secondary = Vec3f::Constant(1.1f * authored.specular);
    material.secondaryExponent = 0.4f * authored.shininess;
    material.primaryShift = 2 * authored.scaleTiltDegrees;
    material.secondaryShift = -3 * authored.scaleTiltDegrees;
    material.fibre = fibreMaterial(authored, view.fibre);
    material.fibreColour = shading::colourOfAbsorption(material.fibre.marschner.azimuthal.absorption,
                                                       roughnessOf(authored, view.fibre))
                               .cast<float>();
    material.axisRatio = static_cast<float>(axisRatioOf(authored, view.fibre));
    material.tubes = authored.tubes;
    material.bounded = authored.energy == EnergyRule::bounded;
    const render::ShadingModel model = material.fibre.model;
    const bool isKajiya = model == render::ShadingModel::kajiya || authored.tubes;
    if (!isKajiya && view.fibre.saysColour()) {
        material.variation = 0;
        return material;
    }
    shading::StrandLook look =
        isKajiya ? colourLook(authored) : absorptionLook(authored, roughnessOf(authored, view.fibre));
    if (isEven(authored, look, own)) return material;
    finishLook(authored, look);
    material.look = look;
    // The tables hold all absorptions: none has to be baked again when a colour moves.
    if (model == render::ShadingModel::marschner) material.fibre.marschner.azimuthal.absorption.setZero();
    return material;
}

render::ShadingModel shadingModel(const HairMaterial& authored, const FibreView& view) {
    static_assert(static_cast<int>(ShadingModel::marschner) ==
                      static_cast<int>(render::ShadingModel::marschner) &&
                  static_cast<int>(ShadingModel::sadeghi) == static_cast<int>(render::ShadingModel::sadeghi));
    return view.model.value_or(static_cast<render::ShadingModel>(authored.shadingModel));
}

bool StrandMaterials::hasLook() const {
    return material.look ||
           std::ranges::any_of(others, [](const auto& other) { return other.look.has_value(); });
}

StrandMaterials strandMaterials(const Groom& groom, const ViewFile& view) {
    const OwnOfStrands own{groom.strandAttributes.has(attribute::kStrandColour),
                           groom.strandAttributes.has(attribute::kMelanin)};
    StrandMaterials materials{strandShading(groom.material, view, own), {}, {}};
    for (const Layer& layer : groom.layers) {
        if (layer.material) materials.others.push_back(strandShading(*layer.material, view, own));
    }
    return materials;
}

std::vector<std::uint32_t> materialsOfStrands(const Groom& groom) {
    std::vector<std::uint32_t> ofLayers;
    std::uint32_t own = 0;
    for (const Layer& layer : groom.layers) {
        if (layer.material) ++own;
        ofLayers.push_back(!layer.visible ? render::kNotDrawn : layer.material ? own : 0);
    }
    const auto hidden = groom.strandAttributes.view<std::uint8_t>(attribute::kHidden);
    const auto isHidden = [&](std::size_t strand) { return strand < hidden.size() && hidden[strand] != 0; };
    std::vector<std::uint32_t> materials = layersOfStrands(groom);
    bool allAlike = true;
    for (std::size_t s = 0; s < materials.size(); ++s) {
        const std::uint32_t layer = materials[s];
        materials[s] = isHidden(s) ? render::kNotDrawn : layer < ofLayers.size() ? ofLayers[layer] : 0;
        allAlike = allAlike && materials[s] == 0;
    }
    return allAlike ? std::vector<std::uint32_t>() : materials;
}

std::vector<std::uint32_t> materialsOfFollowHairs(const Groom& groom, const FollowBindings& bindings) {
    const std::vector<std::uint32_t> strands = materialsOfStrands(groom);
    if (strands.empty()) return {};
    std::vector<std::uint32_t> materials(bindings.hairCount());
    for (std::size_t hair = 0; hair < materials.size(); ++hair)
        materials[hair] = strands[bindings.guideStrands[bindings.guides[hair][0]]];
    return materials;
}

LookWeights weightsOfStrands(const Groom& groom) {
    const Owners owners{authoredMaterials(groom), materialsOfStrands(groom)};
    LookWeights weights;
    if (owners.hasStreaks()) weights.streaks = owners.streaks(rootsOf(groom));
    takePigments(owners, groom, groom.strandAttributes.view<float>(attribute::kMelanin), weights);
    takeLengths(owners, groom, weights);
    if (!owners.isDyed()) return weights;
    if (isPainted(groom)) weights.pointDyes = pointDyes(groom);
    const auto mask =
        isPainted(groom) ? std::span<const float>() : groom.strandAttributes.view<float>(attribute::kDye);
    weights.dyes.resize(groom.strandCount());
    for (std::size_t s = 0; s < weights.dyes.size(); ++s)
        weights.dyes[s] = owners.of(s).dyeStrength * maskOf(mask, s);
    return weights;
}

Result<LookWeights> weightsOfFollowHairs(const Groom& groom, const FollowBindings& bindings) {
    const Owners owners{authoredMaterials(groom), materialsOfFollowHairs(groom, bindings)};
    LookWeights weights;
    const auto melanin = groom.strandAttributes.view<float>(attribute::kMelanin);
    if (owners.hasStreaks() || owners.hasWhite() || owners.hasGrownOut() || !melanin.empty()) {
        const auto rest = bakeFollowHairs(groom, bindings);
        if (!rest) return tl::unexpected(rest.error());
        if (owners.hasStreaks()) weights.streaks = owners.streaks(rootsOf(*rest));
        takePigments(owners, *rest, followHairRootValues(bindings, melanin), weights);
        takeLengths(owners, *rest, weights);
    }
    if (!owners.isDyed()) return weights;
    if (isPainted(groom)) {
        weights.pointDyes = pointDyesOfFollowHairs(groom, bindings);
        weights.dyes.resize(bindings.hairCount());
        for (std::size_t hair = 0; hair < weights.dyes.size(); ++hair)
            weights.dyes[hair] = owners.of(hair).dyeStrength;
        return weights;
    }
    const std::vector<float> mask =
        followHairRootValues(bindings, groom.strandAttributes.view<float>(attribute::kDye));
    weights.dyes.resize(bindings.hairCount());
    for (std::size_t hair = 0; hair < weights.dyes.size(); ++hair)
        weights.dyes[hair] = owners.of(hair).dyeStrength * std::clamp(maskOf(mask, hair), 0.0f, 1.0f);
    return weights;
}

std::vector<float> pointDyesOfFollowHairs(const Groom& groom, const FollowBindings& bindings) {
    if (!isPainted(groom)) return {};
    std::vector<float> dyes =
        followHairValues(groom, bindings, groom.pointAttributes.view<float>(attribute::kPointDye));
    for (float& dye : dyes) dye = std::clamp(dye, 0.0f, 1.0f);
    return dyes;
}

std::vector<float> paintedRadii(const render::RenderStrands& strands, std::span<const float> changes) {
    std::vector<float> radii(strands.positions_ws.size(), 0.0f);
    if (changes.empty() || strands.offsets.empty()) return {};
    constexpr std::size_t kGrain = 256;
    parallelFor(strands.offsets.size() - 1, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const render::StrandShading* const shading = render::shadingOf(strands, s);
            const std::uint32_t first = strands.offsets[s], last = strands.offsets[s + 1];
            for (std::uint32_t p = first; shading && p < last; ++p)
                radii[p] = widened(render::radiusAt(strands, *shading, first, last, p), changes[p]);
        }
    });
    return radii;
}

}  // namespace hairloom
