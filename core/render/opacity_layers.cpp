// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/opacity_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shaders/shared/render_types.h"

namespace hairloom::render {
namespace {

constexpr std::array kEarly{0.0f, 0.04f, 0.14f, 1.0f};

}  // namespace

std::uint32_t& layersOf(RenderOptions& options) {
    if (options.shadows == Shadows::opacityMaps) return options.shadowSlices;
    return options.shadows == Shadows::adaptive ? options.shadowNodes : options.shadowLayers;
}

std::uint32_t layerCount(const RenderOptions& options) {
    if (options.shadows == Shadows::none || options.shadows == Shadows::absorption) return 0;
    RenderOptions of = options;
    return layersOf(of);
}

std::uint32_t layersThatFit(RenderOptions options, const gpu::DeviceInfo& device) {
    std::uint32_t& layers = layersOf(options);
    if (layerCount(options) == 0) return layers;
    const std::uint32_t least = options.shadows == Shadows::opacityMaps ? 1
                                : options.shadows == Shadows::adaptive  ? kMinShadowNodes
                                                                        : kMinShadowLayers;
    const std::uint64_t texels = std::uint64_t{options.shadowResolution} * options.shadowResolution;
    // Of one light: its counts, a word a layer, and its texels.
    const auto bytes = [&] { return 4 * texels * std::max(layers, opacityWords(options.shadows, layers)); };
    while (layers > least && bytes() > device.maxBufferBytes) --layers;
    return layers;
}

std::uint32_t fragmentsThatFit(const RenderOptions& options, const gpu::DeviceInfo& device,
                               const HairCount& hair) {
    constexpr std::uint64_t kOfTexel = 16;            // as many as dense hair has in one of usual size
    constexpr std::uint64_t kOfSmallMap = 1u << 22u;  // whose texels have more
    if (options.shadows != Shadows::adaptive) return 0;
    const std::uint64_t texels = std::uint64_t{options.shadowResolution} * options.shadowResolution;
    // Pieces of hair cover two texels across and one more at each end.
    const std::uint64_t ofHair =
        2 * (2 * hair.strands * options.shadowResolution + 2 * hair.segments * options.subdivisions);
    const std::uint64_t wanted =
        std::min({std::max(kOfTexel * texels, kOfSmallMap), std::uint64_t{options.shadowFragments},
                  std::max(ofHair, std::uint64_t{kMinShadowFragments})});
    constexpr std::uint64_t kShareOfMemory = 16;
    std::uint64_t bytes = device.maxBufferBytes;
    if (device.memoryBytes > 0) bytes = std::min(bytes, device.memoryBytes / kShareOfMemory);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, bytes / (4 * HAIRLOOM_LISTED_WORDS)));
}

std::uint32_t opacityWords(Shadows shadows, std::uint32_t layers) {
    if (layers == 0 || shadows == Shadows::adaptive) return layers;
    const std::uint32_t shares = layers + (shadows == Shadows::deepOpacity ? 1 : 0);
    return 2 * ((shares + 3) / 4);
}

float growthOf(const RenderOptions& options) {
    if (options.shadows != Shadows::deepOpacity || options.layerEnds == LayerEnds::linear) return 1;
    return options.layerEnds == LayerEnds::early ? 0 : options.layerGrowth;
}

float layerEnd(std::uint32_t i, std::uint32_t count, float growth) {
    const auto number = static_cast<float>(i + 1), all = static_cast<float>(count);
    if (growth == 0) {
        const float place = 3 * number / all;
        const std::uint32_t third = place <= 1 ? 0 : place <= 2 ? 1 : 2;
        const float part = place - static_cast<float>(third);
        return part == 1 ? kEarly[third + 1] : kEarly[third] + part * (kEarly[third + 1] - kEarly[third]);
    }
    if (std::abs(growth - 1) < 1e-3f) return number / all;
    return (std::pow(growth, number) - 1) / (std::pow(growth, all) - 1);
}

}  // namespace hairloom::render
