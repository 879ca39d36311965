// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The layers of hair that a texel of a shadow map counts, as shaders/render/opacity.hlsli has them.

#include "core/render/options.h"

namespace hairloom::render {

/// Of the kind of shadow; 0 where it has none.
std::uint32_t layerCount(const RenderOptions& options);

/// The member of the options that says so for their kind of shadow; that of deep opacity maps where it has
/// none.
std::uint32_t& layersOf(RenderOptions& options);

/// As many of those as the device has buffers for, at least one, or three of deep opacity maps, or four
/// nodes; those of the options where the kind has none.
std::uint32_t layersThatFit(RenderOptions options, const gpu::DeviceInfo& device);

/// Of a texel, in words of 32 bits: four shares of 16 bits, a texture of four channels, take two. Deep
/// opacity maps have the first hair's depth as the last of them. A node of adaptive maps takes one.
std::uint32_t opacityWords(Shadows shadows, std::uint32_t layers);

/// Hair in the numbers that lists of an adaptive map are sized by.
struct HairCount {
    std::uint64_t strands = 0, segments = 0;
};

/// Pieces of hair in texels that the lists of an adaptive map hold on this device, no more than that hair can
/// have while each strand is at most twice as long as the light's view is wide; 0 for other shadows.
std::uint32_t fragmentsThatFit(const RenderOptions& options, const gpu::DeviceInfo& device,
                               const HairCount& hair);

/// How layers grow from one to the next, as the shaders know it; 0: LayerEnds::early.
float growthOf(const RenderOptions& options);

/// End of layer `i` of `count`, as a part of the depth that hair takes up, 0…1. `growth`: growthOf().
float layerEnd(std::uint32_t i, std::uint32_t count, float growth);

}  // namespace hairloom::render
