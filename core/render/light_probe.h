// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What light does at chosen places: the passes up to the shadow maps, and the shaders' own functions. For
// measurements and tests.

#include <array>
#include <optional>
#include <vector>

#include "core/gpu/device.h"
#include "core/render/options.h"
#include "core/render/scene.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

/// Ends of three deep opacity layers, as RendererState::deepLayers.
using DeepLayers = std::array<float, 3>;

/// Of the first light, and of light from around. `layers`: in place of those of the options. Errors: what the
/// device reports.
Result<std::vector<shaders::LightAnswer>> probeLight(gpu::Device& device, const RenderScene& scene,
                                                     const RenderOptions& options,
                                                     std::span<const shaders::LightCase> cases,
                                                     const std::optional<DeepLayers>& layers = {});

/// A texel's line in an adaptive map, as shading reads it.
struct NodeTexels {
    std::uint32_t side = 0;            ///< texels; rows from the top
    std::uint32_t nodes = 0;           ///< of a texel, nearest the light first
    std::vector<std::uint32_t> words;  ///< one a node: adaptive.hlsli
    std::uint32_t found = 0;           ///< pieces of hair in texels
    std::uint32_t listed = 0;          ///< of them, those that lists took
};
/// Of the first light with shadows. Errors: shadows that are not adaptive, and as readOpacity().
Result<NodeTexels> readNodes(gpu::Device& device, const RenderScene& scene, const RenderOptions& options);

/// The opacity map of hair that the first light with shadows has, as shading reads it.
struct OpacityTexels {
    std::uint32_t side = 0;     ///< texels; rows from the top
    std::uint32_t layers = 0;   ///< of a texel, nearest the light first
    std::vector<float> fibres;  ///< that each layer holds, those of a texel one after the other
    std::vector<bool> hair;     ///< whether a texel has any
};
/// Errors: shadows without layers, no hair, no light, or what the device reports.
Result<OpacityTexels> readOpacity(gpu::Device& device, const RenderScene& scene,
                                  const RenderOptions& options);

}  // namespace hairloom::render
