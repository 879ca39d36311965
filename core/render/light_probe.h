// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What light does at chosen places: the passes up to the shadow maps, and the shaders' own functions. For
// measurements and tests.

#include <array>
#include <vector>

#include "core/gpu/device.h"
#include "core/render/options.h"
#include "core/render/scene.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

/// Ends of the deep opacity layers, as RendererState::deepLayers.
using DeepLayers = std::array<float, 3>;
inline constexpr DeepLayers kDeepLayers{0.04f, 0.14f, 1.0f};

/// Of the first light, and of light from around. Errors: what the device reports.
Result<std::vector<shaders::LightAnswer>> probeLight(gpu::Device& device, const RenderScene& scene,
                                                     const RenderOptions& options,
                                                     std::span<const shaders::LightCase> cases,
                                                     const DeepLayers& layers = kDeepLayers);

}  // namespace hairloom::render
