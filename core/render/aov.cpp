// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/aov.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom::render {
namespace {

constexpr std::uint32_t kLargestWhole = 1u << 24u;  // up to which 32-bit floats hold all whole numbers

/// Errors: a number that a float does not hold.
Result<ExrLayer> aovLayer(Aov aov, std::span<const SurfacePixel> surface) {
    static constexpr std::array<std::string_view, 4> kChannels{"Z", "X", "XY", "RGB"};
    ExrLayer layer;
    layer.name = kAovNames[static_cast<std::size_t>(aov)];
    layer.channels = kChannels[static_cast<std::size_t>(aov)];
    layer.values.reserve(layer.channels.size() * surface.size());
    for (const SurfacePixel& pixel : surface) {
        switch (aov) {
            case Aov::depth:
                layer.values.push_back(pixel.depth);
                break;
            case Aov::id:
                if (pixel.hasStrand() && pixel.strand > kLargestWhole) {
                    return fail(
                        fmt::format("hair {} has a number that no pixel of the layer id holds", pixel.strand),
                        fmt::format("up to {}", kLargestWhole));
                }
                layer.values.push_back(pixel.hasStrand() ? static_cast<float>(pixel.strand) : -1.0f);
                break;
            case Aov::velocity:
                layer.values.insert(layer.values.end(), {pixel.velocityX, pixel.velocityY});
                break;
            case Aov::albedo:
                layer.values.insert(layer.values.end(), pixel.albedo.begin(), pixel.albedo.begin() + 3);
                break;
        }
    }
    return layer;
}

}  // namespace

Result<std::vector<ExrLayer>> aovLayers(std::span<const std::string> names,
                                        std::span<const SurfacePixel> surface) {
    std::vector<ExrLayer> layers;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(kAovNames, name);
        if (found == kAovNames.end()) return fail("no layer '" + name + "'", "depth, id, velocity or albedo");
        auto layer = aovLayer(static_cast<Aov>(found - kAovNames.begin()), surface);
        if (!layer) return tl::unexpected(layer.error());
        layers.push_back(std::move(*layer));
    }
    return layers;
}

}  // namespace hairloom::render
