// SPDX-License-Identifier: GPL-3.0-or-later
// How much room hair takes, and what follows for how much of it is drawn.
#include <algorithm>
#include <cmath>

#include "core/render/device_scene.h"

namespace hairloom::render {
namespace {

std::uint64_t cellOf(const Vec3f& p, float size) {
    const auto place = [&](float x) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / size)) + (1 << 20)) &
               0x1fffffu;
    };
    return place(p.x()) | place(p.y()) << 21u | place(p.z()) << 42u;
}

std::size_t countDistinct(std::vector<std::uint64_t> cells) {
    std::ranges::sort(cells);
    return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

/// At places along some strands, for what they let through.
std::vector<Vec3d> absorptionsOf(const MaterialOnDevice& material) {
    constexpr int kPlaces = 6;
    std::vector<Vec3d> absorptions;
    if (!material.shading.look) return absorptions;
    const auto count = static_cast<double>(material.someStrands.size());
    for (std::size_t s = 0; s < material.someStrands.size(); ++s) {
        const shaders::StrandHeader& strand = material.someStrands[s];
        const Vec3d own = Vec3f(strand.albedo.x, strand.albedo.y, strand.albedo.z).cast<double>();
        for (int i = 0; i < kPlaces; ++i) {
            // Strands stand in an order of chance: even steps of the random number are its spread.
            const double random = (static_cast<double>(s) + 0.5) / count;
            absorptions.push_back(shading::lookAt(
                *material.shading.look, {.along = (i + 0.5) / kPlaces,
                                         .random = random,
                                         .streak = static_cast<double>(strand.streak),
                                         .dye = static_cast<double>(strand.dye * material.someDyes[s]),
                                         .pigment = static_cast<double>(strand.pigment),
                                         .length = static_cast<double>(strand.length),
                                         .ownColour = strand.albedo.w > 0 ? &own : nullptr}));
        }
    }
    return absorptions;
}

}  // namespace

float HairDetail::widening() const {
    const float full = 0.9f * share;
    const float none = 1.1f * share;
    if (full >= 1) return 1;
    if (none <= 1) return 1 / share;
    // The mean over all strands of the factors of levelWidth() in shaders/curve.comp.hlsl.
    const float fading = (none - full) * (none - full) - (none - 1) * (none - 1);
    return 1 / (full + fading / (2 * (none - full)));
}

void DeviceScene::measureSpace(const RenderScene& scene) {
    constexpr float kCell = 0.01f;  // metres, about a wisp
    std::vector<std::uint64_t> cells;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const RenderStrands& strands = scene.strands[g];
        StrandGroup& group = groups[g];
        for (std::size_t i = 0; i + 1 < strands.offsets.size(); ++i) {
            const std::uint32_t material = strands.materials.empty() ? 0 : strands.materials[i];
            if (material == kNotDrawn) continue;
            double& length = group.materials[material].length;
            for (std::uint32_t p = strands.offsets[i] + 1; p < strands.offsets[i + 1]; ++p) {
                const Vec3f& a = strands.positions_ws[p - 1];
                const Vec3f& b = strands.positions_ws[p];
                const double step = static_cast<double>((b - a).norm());
                group.length += step;
                length += step;
                ++group.segments;
                if (group.hasRadiiOf(material)) {
                    group.materials[material].ownRadius +=
                        step * static_cast<double>(0.5f * (strands.radii[p - 1] + strands.radii[p]));
                }
                cells.push_back(cellOf(0.5f * (a + b), kCell));
            }
        }
        for (MaterialOnDevice& material : group.materials) {
            if (material.length > 0) material.ownRadius /= material.length;
        }
    }
    const double cell = static_cast<double>(kCell);
    for (const unsigned axis : {0u, 21u, 42u}) {
        auto flat = cells;
        for (std::uint64_t& c : flat) c &= ~(std::uint64_t{0x1fffff} << axis);
        hairShadow_ += static_cast<double>(countDistinct(std::move(flat))) * cell * cell / 3;
    }
    hairVolume_ = static_cast<double>(countDistinct(std::move(cells))) * cell * cell * cell;
}

HairFlux DeviceScene::flux() const {
    if (groups.empty()) return {};
    const auto& material = *std::ranges::max_element(groups.front().materials, {}, &MaterialOnDevice::length);
    return material.fibre.flux(absorptionsOf(material));
}

HairMeasure DeviceScene::measure() const {
    double length = 0, surface = 0;
    std::size_t segments = 0;
    for (const StrandGroup& group : groups) {
        length += group.length;
        for (std::size_t m = 0; m < group.materials.size(); ++m) {
            const MaterialOnDevice& material = group.materials[m];
            // The profile of shaders/curve.comp.hlsl has this mean.
            const double authored =
                static_cast<double>(material.shading.radius * (2 + material.shading.tipScale) / 3);
            const double radius = group.hasRadiiOf(m) ? material.ownRadius : authored;
            surface += material.length * 2 * radius;
        }
        segments += group.segments;
    }
    HairMeasure result;
    if (!(length > 0) || !(hairVolume_ > 0)) return result;
    result.segment = static_cast<float>(length / static_cast<double>(segments));
    result.diameter = static_cast<float>(surface / length);
    // Of cylinders in all directions a ray sees π/4 of length times diameter.
    const double crossed = surface * static_cast<double>(kPi) / 4;
    result.fibresPerMetre = static_cast<float>(crossed / hairVolume_);
    result.fibresThrough = static_cast<float>(crossed / hairShadow_);
    return result;
}

}  // namespace hairloom::render
