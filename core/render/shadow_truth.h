// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shadows of hair against hair: fibres that stand between points and a directional light, counted on the CPU
// in double precision, and how far a map is from them.

#include "core/render/light_probe.h"

namespace hairloom::render {

struct ShadowCases {
    std::vector<shaders::LightCase> cases;  ///< of probeLight()
    std::vector<double> counted;            ///< mean number of fibres that a beam to the light crosses
};

inline constexpr double kShadowFootprint = 0.0025;  ///< metres, radius of the beams around points

/// `count` points of the scene's hair, by chance. Fibres are straight between the points they are given by,
/// as with one subdivision. The scene has one group of strands with radii and one directional light.
ShadowCases countFibres(const RenderScene& scene, std::size_t count, std::uint64_t seed);

/// Root of the mean square error of the transmittance exp(−n/2), with one subdivision. Errors: as
/// probeLight().
Result<double> shadowError(gpu::Device& device, const RenderScene& scene, const ShadowCases& cases,
                           RenderOptions options, const std::optional<DeepLayers>& layers = {});

/// Shadows of the head on hair, found by rays.
struct HeadCases {
    std::vector<shaders::LightCase> cases;  ///< of probeLight()
    std::vector<double> visible;            ///< 1 where nothing of the head is in the light's way, else 0
};

/// `count` points of the scene's hair, by chance. The scene has one mesh, one group of strands and one
/// directional light.
HeadCases castRays(const RenderScene& scene, std::size_t count, std::uint64_t seed);

/// Root of the mean square error of what the head leaves of the light; `absorption` as
/// RenderOptions::headAbsorption. Errors: as probeLight().
Result<double> headShadowError(gpu::Device& device, const RenderScene& scene, const HeadCases& cases,
                               float absorption, std::uint32_t resolution);

}  // namespace hairloom::render
