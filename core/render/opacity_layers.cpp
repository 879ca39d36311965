// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/opacity_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hairloom::render {
namespace {

constexpr std::array kEarly{0.0f, 0.04f, 0.14f, 1.0f};

}  // namespace

std::uint32_t layerCount(const RenderOptions& options) {
    if (options.shadows == Shadows::deepOpacity) return options.shadowLayers;
    return options.shadows == Shadows::opacityMaps ? options.shadowSlices : 0;
}

std::uint32_t layersThatFit(RenderOptions options, const gpu::DeviceInfo& device) {
    const bool slices = options.shadows == Shadows::opacityMaps;
    std::uint32_t& layers = slices ? options.shadowSlices : options.shadowLayers;
    if (layerCount(options) == 0) return layers;
    const std::uint64_t texels = std::uint64_t{options.shadowResolution} * options.shadowResolution;
    // Of one light: its counts, a word a layer, and its texels.
    const auto bytes = [&] { return 4 * texels * std::max(layers, opacityWords(options.shadows, layers)); };
    while (layers > (slices ? 1 : kMinShadowLayers) && bytes() > device.maxBufferBytes) --layers;
    return layers;
}

std::uint32_t opacityWords(Shadows shadows, std::uint32_t layers) {
    if (layers == 0) return 0;
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
