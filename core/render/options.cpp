// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/options.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/render/light.h"
#include "core/render/opacity_layers.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

Status check(const RenderOptions& o, const gpu::DeviceInfo& device) {
    const std::uint64_t pixels = std::uint64_t{o.width} * o.height;
    const std::uint32_t limit = device.maxTextureSize;
    if (pixels == 0 || o.width > limit || o.height > limit || pixels > kMaxPixels) {
        return fail(fmt::format("an image of {}x{} pixels", o.width, o.height),
                    fmt::format("1 to {} along a side and at most {} in all", limit, kMaxPixels));
    }
    if (o.frames < 1 || o.frames > 1024) return fail(fmt::format("{} frames", o.frames), "1 to 1024");
    if (o.subdivisions < 1 || o.subdivisions > kMaxSubdivisions) {
        return fail(fmt::format("{} subdivisions", o.subdivisions), "1 to 64");
    }
    if (o.shadowResolution < kMinShadowResolution || o.shadowResolution > kMaxShadowResolution ||
        o.shadowResolution > limit)
        return fail(fmt::format("a shadow map of {} pixels", o.shadowResolution), "64 to 4096");
    struct Count {
        std::uint32_t count, least, most;
        const char* what;
    };
    for (const auto& [count, least, most, what] :
         {Count{o.shadowLayers, kMinShadowLayers, kMaxShadowLayers, "{} layers of deep opacity maps"},
          Count{o.shadowSlices, 1, kMaxShadowSlices, "{} slices of opacity maps"},
          Count{o.shadowNodes, kMinShadowNodes, kMaxShadowNodes, "{} nodes of adaptive shadow maps"},
          Count{o.shadowFragments, kMinShadowFragments, kMaxShadowFragments,
                "lists of {} pieces of hair for adaptive shadow maps"},
          Count{o.lightCells, kMinLightCells, kMaxLightCells, "{} cells for light between hairs"},
          Count{o.lightPhotons, kMinLightPhotons, kMaxLightPhotons, "{} photons for light between hairs"},
          Count{o.shadowLights, 1, kMaxLights, "{} lights with shadows"}}) {
        if (count < least || count > most)
            return fail(fmt::format(fmt::runtime(what), count), fmt::format("{} to {}", least, most));
    }
    if (!(o.layerGrowth >= 1 && o.layerGrowth <= kMaxLayerGrowth))
        return fail(fmt::format("layers that grow by {}", o.layerGrowth),
                    fmt::format("1 to {}", kMaxLayerGrowth));
    if (o.skyStrands < 64)
        return fail(fmt::format("{} strands in maps of the sky", o.skyStrands), "at least 64");
    if (!(o.headAbsorption >= 0 && o.headAbsorption <= kMaxHeadAbsorption)) {
        return fail(fmt::format("an absorption behind the head of {} per metre", o.headAbsorption),
                    "0 to 10000");
    }
    if (!(o.shadowBlur >= 0 && o.shadowBlur <= kMaxShadowBlur)) {
        return fail(fmt::format("shadows blurred by {} pixels", o.shadowBlur), "0 to 32");
    }
    if (!(o.detail >= 0 && o.detail <= 100)) return fail("a detail outside 0 to 100 pixels", "0 to 100");
    if (o.temporal && (o.frames != 1 || o.shadowBlur > 0))
        return fail("frames that join those before them as an average or with blurred shadows",
                    "one of them");
    if (o.ribbons == Ribbons::tessellated && !device.tessellation) {
        return fail("tessellated ribbons on " + device.name, "a device with tessellation");
    }
    if (o.ribbons == Ribbons::compute && o.transparency == Transparency::weighted) {
        return fail("hair that kernels rasterise, blended by weights",
                    "stochastic or a fixed set of samples");
    }
    if (o.transparency == Transparency::sorted && o.ribbons != Ribbons::compute &&
        o.ribbons != Ribbons::automatic) {
        return fail("hair blended in its order and not rasterised by kernels", "ribbons by kernels");
    }
    if (!(o.exposure > 0) || !(o.exposure < 1e6f))
        return fail("an exposure that is not positive", "above 0, below 1e6");
    return {};
}

std::uint32_t mapsThatFit(const RenderOptions& options, const gpu::DeviceInfo& device) {
    // Depths of heads lie side by side in a texture, the words of a texel of opacity in a buffer.
    const std::uint64_t side = options.shadowResolution;
    const std::uint64_t bytes =
        4 * std::max<std::uint64_t>(opacityWords(options.shadows, layerCount(options)), 2);
    const std::uint64_t room =
        std::min<std::uint64_t>(device.maxTextureSize / side, device.maxBufferBytes / (bytes * side * side));
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(room, 1, HAIRLOOM_MAX_LIGHTS + HAIRLOOM_CLOSE_MAPS));
}

std::uint32_t shadowLightsOf(const RenderOptions& options, const gpu::DeviceInfo& device) {
    return std::clamp<std::uint32_t>(options.shadowLights, 1, mapsThatFit(options, device));
}

Result<std::uint32_t> chooseSamples(const RenderOptions& options, const gpu::DeviceInfo& device) {
    if (options.samples == 0) return std::min(device.maxSamples(), 8u);
    if (std::ranges::find(device.sampleCounts, options.samples) == device.sampleCounts.end() ||
        options.samples > 8) {
        std::string counts;
        for (const std::uint32_t n : device.sampleCounts)
            counts += (counts.empty() ? "" : ", ") + std::to_string(n);
        return fail(fmt::format("{} samples per pixel on {}", options.samples, device.name),
                    "one of " + counts);
    }
    return options.samples;
}

RenderOptions chooseWays(const RenderOptions& options, std::uint32_t samples, bool kernels,
                         const gpu::DeviceInfo& device) {
    RenderOptions chosen = options;
    layersOf(chosen) = layersThatFit(chosen, device);
    const std::uint64_t words =
        std::uint64_t{options.width} * options.height * std::max(samples, std::uint32_t{HAIRLOOM_FRAGMENTS});
    const bool fits = words * sizeof(std::uint32_t) <= device.maxBufferBytes;
    // A software device has no fixed-function units to be slower than its kernels.
    const bool gpu = kernels && fits && device.type != gpu::DeviceType::Cpu;
    if (chosen.transparency == Transparency::automatic) {
        const bool free = chosen.ribbons == Ribbons::automatic;
        const bool sorts = kernels && fits && (free ? gpu : chosen.ribbons == Ribbons::compute);
        chosen.transparency = chosen.frames > 1 ? Transparency::stochastic
                              : sorts           ? Transparency::sorted
                              : chosen.temporal || chosen.ribbons == Ribbons::compute
                                  ? Transparency::stochastic
                                  : Transparency::weighted;
    }
    if (!kernels && chosen.transparency == Transparency::sorted)
        chosen.transparency = Transparency::stochastic;
    if (chosen.ribbons == Ribbons::automatic) {
        const bool compute = chosen.transparency == Transparency::sorted ||
                             (gpu && chosen.transparency != Transparency::weighted);
        chosen.ribbons = compute ? Ribbons::compute : Ribbons::strip;
    }
    if (!kernels && chosen.ribbons == Ribbons::compute) chosen.ribbons = Ribbons::strip;
    return chosen;
}

}  // namespace hairloom::render
