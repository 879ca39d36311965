// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Textures that the passes draw into.

#include "core/gpu/device.h"
#include "core/render/options.h"

namespace hairloom::render {

inline constexpr gpu::Format kColourFormat = gpu::Format::Rgba16Float;

struct Targets {
    gpu::TexturePtr headDepth, firstHair, opacity;  ///< shadow atlas: one square a light, side by side
    gpu::TexturePtr colour, resolved, depth;
    gpu::TexturePtr sum;           ///< of the frames that are averaged
    gpu::TexturePtr overlayDepth;  ///< of the meshes alone, one sample a pixel

    /// What the frame has drawn, one sample a pixel.
    const gpu::TexturePtr& frame() const { return resolved != nullptr ? resolved : colour; }
};

/// Makes what is missing or has another size, lets go what is not needed. `changed` is set when a texture
/// that keeps its content from frame to frame was made anew: the shadow atlas or the sum.
struct TargetChanges {
    bool shadows = false;
    bool picture = false;
};
Result<TargetChanges> fitTargets(gpu::Device& device, const RenderOptions& options, std::uint32_t samples,
                                 bool overlayNeedsDepth, Targets& targets);

}  // namespace hairloom::render
