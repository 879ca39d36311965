// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_looks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/interpolation/follow_hairs.h"
#include "core/live/hair_look.h"
#include "core/render/clumping.h"
#include "core/render/game_fibre.h"
#include "core/render/passes.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom {
namespace {

namespace asset = runtime::asset;
using shading::Lobe;

std::array<float, 4> rowOf(const Vec3f& colour, float w = 0) {
    return {colour.x(), colour.y(), colour.z(), w};
}

/// Of hair that looks the same everywhere, too.
shading::StrandLook lookOf(const HairMaterial& authored, const render::StrandShading& shown) {
    if (shown.look) return *shown.look;
    shading::StrandLook look;
    look.ownScale = shading::absorptionScale(static_cast<double>(authored.azimuthalRoughness));
    if (shown.fibre.model == render::ShadingModel::kajiya) {
        look.root = look.tip = shown.albedo.cast<double>();
    } else {
        look.quantity = shading::LookQuantity::absorption;
        look.root = look.tip = shown.fibre.marschner.azimuthal.absorption;
    }
    look.streakRoot = look.streakTip = look.root;
    return look;
}

void takeLook(const shading::StrandLook& look, asset::Material& material) {
    const shaders::LookConstants constants = render::lookConstants(look);
    static_assert(sizeof constants == offsetof(asset::Material, primary));
    std::memcpy(&material, &constants, sizeof constants);
}

void takeKajiya(const render::StrandShading& shown, asset::Material& material) {
    const auto normalisation = [](float exponent) {
        return static_cast<float>(
            1 / (std::numbers::pi * shading::kajiyaReflectance(static_cast<double>(exponent))));
    };
    const auto tangent = [](float degrees) {
        return static_cast<float>(std::tan(static_cast<double>(degrees) * shading::kDegree));
    };
    material.primary = rowOf(shown.primary, shown.primaryExponent);
    material.secondary = rowOf(shown.secondary, shown.secondaryExponent);
    material.primaryTilt = tangent(shown.primaryShift);
    material.secondaryTilt = tangent(shown.secondaryShift);
    material.primaryNormalisation = normalisation(shown.primaryExponent);
    material.secondaryNormalisation = normalisation(shown.secondaryExponent);
    material.diffuse = shown.diffuse;
    material.diffuseNormalisation = normalisation(0);
    material.scattering = shown.scattering;
    material.fibreOpacity = shown.opacity;
    material.axisRatio = shown.axisRatio;
}

void takeFibre(const shading::MarschnerParameters& fibre, asset::Material& material) {
    const shading::Marschner model(fibre);
    for (const Lobe lobe : shading::kLobes) {
        const std::size_t l = shading::index(lobe);
        material.tilts[l] = static_cast<float>(model.longitudinalLobe(lobe).tilt());
        material.widths[l] = static_cast<float>(model.longitudinalLobe(lobe).width());
        material.scales[l] = static_cast<float>(model.scale(lobe));
    }
}

std::uint16_t inSteps(float value, float step) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value / step, 0.0f, 65535.0f)));
}

/// As much as the hair's points have in the mean.
std::vector<float> dyesOfHairs(const LookWeights& weights, std::size_t pointsPerHair) {
    std::vector<float> dyes = weights.dyes;
    for (std::size_t hair = 0; hair < dyes.size() && !weights.pointDyes.empty(); ++hair) {
        float sum = 0;
        for (std::size_t p = 0; p < pointsPerHair; ++p) sum += weights.pointDyes[hair * pointsPerHair + p];
        dyes[hair] *= sum / static_cast<float>(pointsPerHair);
    }
    return dyes;
}

std::vector<asset::HairLook> looksOfHairs(const LookWeights& weights, const FollowBindings& bindings) {
    if (weights.streaks.empty() && weights.dyes.empty() && weights.pigments.empty()) return {};
    const std::vector<float> dyes = dyesOfHairs(weights, bindings.pointsPerHair);
    std::vector<asset::HairLook> looks(bindings.hairCount(), {0, 0, asset::kPlainPigment, 0});
    for (std::size_t hair = 0; hair < looks.size(); ++hair) {
        asset::HairLook& look = looks[hair];
        if (!weights.streaks.empty()) look.streak = inSteps(weights.streaks[hair], 1.0f / 65535);
        if (!dyes.empty()) look.dye = inSteps(dyes[hair], 1.0f / 65535);
        if (!weights.pigments.empty())
            look.pigment = inSteps(weights.pigments[hair], 1.0f / static_cast<float>(asset::kPlainPigment));
        if (!weights.lengths.empty()) look.length = inSteps(weights.lengths[hair], asset::kLengthStep);
    }
    return looks;
}

/// Fibres in light's way by those that are counted.
float clumpingOf(std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions,
                 const render::StrandShading& shown) {
    render::RenderStrands strands;
    strands.offsets = offsets;
    strands.positions_ws = positions;
    strands.material = shown;
    return render::measureClumping(std::span(&strands, 1)).widest();
}

}  // namespace

Result<HairLooks> hairLooks(const Groom& groom) {
    HairLooks looks;
    const StrandMaterials shown = strandMaterials(groom, ViewFile{});
    float clumping = 1;
    if (groom.interpolation.followPerGuide > 0) {
        const auto bindings = bindFollowHairs(groom, groom.interpolation);
        if (!bindings) return tl::unexpected(bindings.error());
        const auto rest = bakeFollowHairs(groom, *bindings);
        if (!rest) return tl::unexpected(rest.error());
        const auto weights = weightsOfFollowHairs(groom, *bindings);
        if (!weights) return tl::unexpected(weights.error());
        looks.hairs = looksOfHairs(*weights, *bindings);
        clumping = clumpingOf(rest->offsets.view(), rest->positions(), shown.material);
        if (!weights->pointDyes.empty())
            looks.findings.push_back(
                {Severity::Warning, "dye that was painted along hairs is even along them in a game's shaders",
                 "dye", "set dyeStart and dyeEnd of the material in place of painting"});
    } else {
        clumping = clumpingOf(groom.offsets.view(), groom.positions(), shown.material);
    }
    std::vector<const HairMaterial*> authored{&groom.material};
    for (const Layer& layer : groom.layers) {
        if (layer.material) authored.push_back(&*layer.material);
    }
    for (std::size_t m = 0; m < authored.size(); ++m) {
        const render::StrandShading& one = m == 0 ? shown.material : shown.others[m - 1];
        asset::Material material{};
        takeLook(lookOf(*authored[m], one), material);
        takeKajiya(one, material);
        const float brightest = std::max(one.fibreColour.maxCoeff(), 1e-3f);
        material.tilts[3] = 1 / brightest;
        material.widths[3] = one.variation;
        material.scales[3] = clumping;
        material.bounded = one.bounded ? 1 : 0;
        if (one.fibre.model != render::ShadingModel::kajiya && !one.tubes) {
            material.model = asset::kMarschner;
            material.table = static_cast<std::uint32_t>(looks.tables.size() / asset::kTableHalves);
            takeFibre(one.fibre.marschner, material);
            const std::vector<std::uint16_t> tables = render::gameFibreTables(one.fibre.marschner);
            looks.tables.insert(looks.tables.end(), tables.begin(), tables.end());
        }
        if (one.fibre.model == render::ShadingModel::sadeghi)
            looks.findings.push_back(
                {Severity::Info,
                 "hair of Sadeghi's model is Marschner's of the same fibre in a game's shaders", "material",
                 ""});
        looks.materials.push_back(material);
    }
    return looks;
}

}  // namespace hairloom
