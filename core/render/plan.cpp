// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/plan.h"

#include <fmt/format.h>

#include <numeric>

#include "core/render/opacity_layers.h"
#include "shaders/shared/light_grid_types.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {
namespace {

using gpu::Format;

class Planner {
  public:
    Planner(const SceneFacts& facts, const RenderOptions& options, std::uint32_t samples)
        : facts_(facts), options_(options), samples_(samples) {}

    RenderPlan plan() {
        planShadows();
        planSky();
        planLightGrid();
        planPicture();
        planOutput();
        planOverlay();
        plan_.tables = {facts_.tableBytes, facts_.tableBytes > 0 ? "fibre scattering is read from tables"
                                                                 : "no hair, or a model without tables"};
        return std::move(plan_);
    }

  private:
    void pass(Pass which, bool on, std::string why) {
        plan_.passes[static_cast<std::size_t>(which)] = {on, std::move(why)};
    }
    bool runs(Pass which) const { return plan_.runs(which); }
    void atlas(TargetId which, std::uint32_t size, std::uint32_t squares, bool wanted, std::string why) {
        if (!wanted) return;
        plan_.targets[static_cast<std::size_t>(which)] = {size * squares, size, Format::D32Float, 1,
                                                          std::move(why)};
    }
    void picture(TargetId which, Format format, std::uint32_t samples, bool wanted, std::string why) {
        if (!wanted) return;
        plan_.targets[static_cast<std::size_t>(which)] = {options_.width, options_.height, format, samples,
                                                          std::move(why)};
    }

    void buffer(BufferId which, std::uint64_t elements, std::uint32_t elementBytes, bool wanted,
                std::string why) {
        if (wanted) {
            plan_.buffers[static_cast<std::size_t>(which)] = {elements, elementBytes, std::move(why)};
        }
    }
    std::uint64_t pixels() const { return std::uint64_t{options_.width} * options_.height; }

    void planShadows() {
        const bool cast = facts_.shadowLights > 0;
        const bool receivers = facts_.hair || facts_.meshes;
        const bool on = cast && receivers && options_.shadows != Shadows::none;
        const std::string off = options_.shadows == Shadows::none ? "shadows are turned off"
                                : !cast                           ? "no light casts shadows"
                                                                  : "nothing receives them";
        const bool hair = on && facts_.hair;
        plan_.closeMaps = hair ? facts_.closeMaps : 0;
        const std::uint32_t squares = facts_.shadowLights + plan_.closeMaps;
        const bool layers = hair && options_.shadows != Shadows::absorption;
        const bool adaptive = hair && options_.shadows == Shadows::adaptive;
        const bool first = hair && !adaptive && options_.shadows != Shadows::opacityMaps;
        const std::string noHair = on ? "no hair to cast them" : off;
        pass(Pass::headDepth, on && facts_.meshes,
             !on ? off
             : facts_.meshes
                 ? fmt::format("the head shadows hair and itself from {} lights", facts_.shadowLights)
                 : "no head to cast shadows");
        pass(Pass::firstHair, first,
             first      ? "depths in hair are relative to the first one that a light hits"
             : adaptive ? "lists need no first depth"
             : hair     ? "fixed layers need no first depth"
                        : noHair);
        pass(Pass::opacity, layers,
             layers ? layersWhy()
             : hair ? "absorption assumes evenly spread hair"
                    : noHair);
        atlas(TargetId::headDepth, options_.shadowResolution, squares, on && facts_.meshes,
              "parts of the head that occlude the lights");
        const std::uint64_t square = std::uint64_t{options_.shadowResolution} * options_.shadowResolution;
        const bool deep = options_.shadows == Shadows::deepOpacity;
        buffer(BufferId::firstHair, square * squares, 4, first, "first hair seen from the lights");
        const std::uint32_t count = layerCount(options_);
        buffer(BufferId::layerCounts, square * (adaptive ? 2 : count), 4, layers,
               adaptive ? "where the lists of one light's texels begin, and what they have"
                        : "fibres of one light's layers during counting");
        buffer(BufferId::fragmentCounts, std::uint64_t{2} * squares, 4, adaptive,
               "pieces of hair in texels, and those in lists");
        buffer(BufferId::lightFragments, std::uint64_t{HAIRLOOM_LISTED_WORDS} * facts_.fragments, 4,
               adaptive && facts_.fragments > 0,
               fmt::format("lists of {} pieces of hair in the texels of one light", facts_.fragments));
        buffer(BufferId::opacity, opacityWords(options_.shadows, count) * square * squares, 4, layers,
               deep       ? fmt::format("{} layers and the depth they are relative to", count)
               : adaptive ? fmt::format("{} nodes of a texel's transmittance", count)
                          : fmt::format("{} slices", count));
    }

    std::string layersWhy() const {
        const std::uint32_t count = layerCount(options_);
        std::string why = options_.shadows == Shadows::deepOpacity
                              ? fmt::format("counts hair in {} layers behind the first", count)
                          : options_.shadows == Shadows::adaptive
                              ? fmt::format(
                                    "sorts the hair in each texel and keeps {} nodes of its "
                                    "transmittance",
                                    count)
                              : fmt::format("counts hair in {} slices at fixed depths", count);
        if (facts_.askedLayers > count)
            why += fmt::format(", since {} do not fit in a buffer of this device", facts_.askedLayers);
        if (plan_.closeMaps > 0)
            why += fmt::format("; once more from {} lights of what is near the camera", plan_.closeMaps);
        return why;
    }

    void planSky() {
        constexpr std::uint64_t kSquare = std::uint64_t{kSkyResolution} * kSkyResolution;
        constexpr std::uint64_t kMaps = HAIRLOOM_SKY_MAPS;
        const bool receivers = facts_.hair || facts_.meshes;
        const bool on = facts_.environment && receivers && options_.shadows != Shadows::none;
        const std::string off = options_.shadows == Shadows::none ? "shadows are turned off"
                                : !facts_.environment             ? "no environment light"
                                                                  : "nothing receives it";
        const bool hair = on && facts_.hair;
        const std::string noHair = on ? "no hair to occlude the environment" : off;
        pass(Pass::skyHead, on && facts_.meshes,
             !on             ? off
             : facts_.meshes ? fmt::format("the head occludes the sky, seen from {} sides", kMaps)
                             : "no head to occlude the sky");
        pass(Pass::skyFirst, hair,
             hair ? "depths in hair are relative to the first one from each side" : noHair);
        pass(Pass::skyLayers, hair,
             hair ? fmt::format("counts hair in three layers from {} sides", kMaps) : noHair);
        pass(Pass::skySeen, hair,
             hair ? "each point of a curve looks up its visible share of the sky" : noHair);
        atlas(TargetId::skyHead, kSkyResolution, HAIRLOOM_SKY_MAPS, on && facts_.meshes,
              "parts of the head that occlude the sky");
        buffer(BufferId::skyFirst, kSquare * kMaps, 4, hair, "first hair seen from each side");
        buffer(BufferId::skyCounts, kSquare * 3, 4, hair, "fibres of one side's layers during counting");
        buffer(BufferId::skyLayers, 2 * kSquare * kMaps, 4, hair,
               "three layers and the depth they are relative to");
    }

    void planLightGrid() {
        const bool light = facts_.shadowLights > 0 || facts_.environment;
        const bool on = facts_.hair && facts_.volume && light && options_.shadows != Shadows::none;
        pass(Pass::lightGrid, on,
             on ? fmt::format("follows {} photons from hair to hair and skin", options_.lightPhotons)
             : !facts_.hair                      ? "no hair"
             : !facts_.volume                    ? "no material asks for light in a volume"
             : options_.shadows == Shadows::none ? "shadows are turned off"
                                                 : "no light casts shadows");
        const std::uint64_t cells = options_.lightCells;
        buffer(BufferId::lightCells, cells * HAIRLOOM_GRID_CELL_WORDS, 4, on, "hair and skin in cells");
        buffer(BufferId::lightSums, cells * HAIRLOOM_GRID_LIGHT_WORDS, 4, on, "light through each cell");
        buffer(BufferId::lightGrid, cells * HAIRLOOM_GRID_FLOATS, 16, on, "the same, for shading");
    }

    void planPicture() {
        const bool blends = facts_.hair && options_.transparency == Transparency::weighted;
        pass(Pass::curves, facts_.hair,
             facts_.hair ? fmt::format("{} curve segments per segment of a strand", options_.subdivisions)
                         : "no hair");
        pass(Pass::shade, facts_.hair,
             facts_.hair ? fmt::format("{} lights, once per point of a curve; {}", facts_.lights,
                                       facts_.look ? "colour or absorption varies"
                                                   : "all hair of a material looks the same")
                         : "no hair");
        const bool across = facts_.hair && facts_.across && options_.shadowBlur == 0;
        pass(Pass::across, across,
             across ? fmt::format("hair is wider than a pixel: {} parts of its width have light of their own",
                                  HAIRLOOM_ACROSS_CELLS)
             : options_.shadowBlur > 0 ? "blurred shadows"
             : facts_.hair             ? "no hair of fibres is wider than a pixel"
                                       : "no hair");
        const bool surface = options_.surface || options_.temporal;
        pass(Pass::surface, surface,
             surface ? "depth, strand, velocity and albedo of the nearest surface in each pixel"
                     : "no AOV was requested");
        pass(Pass::temporal, options_.temporal,
             options_.temporal ? "accumulates frames, each pixel at the previous place of its surface"
                               : "frames are not accumulated");
        for (const BufferId id : {BufferId::history, BufferId::otherHistory})
            buffer(id, pixels(), 16, options_.temporal, "light of the previous frames");
        for (const BufferId id : {BufferId::historyPixels, BufferId::otherHistoryPixels})
            buffer(id, pixels(), sizeof(shaders::TemporalPixel), options_.temporal,
                   "surfaces of the previous frames");
        buffer(BufferId::surfaceNearest, pixels(), 4, surface, "depth at the centre of each pixel");
        buffer(BufferId::surfaceItem, pixels(), 4, surface, "index of the point or triangle");
        buffer(BufferId::surface, pixels(), sizeof(shaders::SurfacePixel), surface,
               "depth, strand, velocity and albedo");
        const bool kernels = options_.ribbons == Ribbons::compute;
        const bool sorts = kernels && facts_.hair && options_.transparency == Transparency::sorted;
        pass(Pass::nearest, kernels,
             sorts     ? "the head in front, and the nearest hairs of each pixel"
             : kernels ? "the nearest surface in each sample"
                       : "the rasteriser of the device finds the nearest surface");
        pass(Pass::draw, true,
             sorts     ? "light of the nearest hairs of each pixel, blended in order"
             : kernels ? "light of the nearest surface"
             : blends  ? "the head, and hair that covers whole samples"
                       : "head, hair and background");
        pass(Pass::blend, blends,
             blends ? "thin hair is blended in any order" : "no hair uses weighted transparency");
        pass(Pass::composite, blends,
             blends ? "blended hair is composited over the head" : "no hair was blended");
        const std::string many =
            samples_ > 1 ? fmt::format("{} samples per pixel", samples_) : "one sample per pixel";
        picture(TargetId::colour, kColourFormat, samples_, !kernels, "linear light, " + many);
        picture(TargetId::resolved, kColourFormat, 1, !kernels && samples_ > 1, "average of the samples");
        picture(TargetId::depth, Format::D32Float, samples_, !kernels, "nearest surface, " + many);
        buffer(BufferId::nearest, pixels() * samples_, 4, kernels, "depth of the nearest surface, " + many);
        buffer(BufferId::light, pixels() * samples_, 4, kernels,
               "linear light with a common exponent, " + many);
        buffer(BufferId::fragmentDepths, pixels() * HAIRLOOM_FRAGMENTS, 4, sorts,
               "depths of the nearest hairs of each pixel");
        buffer(BufferId::fragmentLight, pixels() * HAIRLOOM_FRAGMENTS, 4, sorts,
               "their light with a common exponent");
        buffer(BufferId::fragmentCover, pixels() * HAIRLOOM_COVER_WORDS, 4, sorts,
               "their coverage, and the transmittance of all hair");
        picture(TargetId::blendSum, Format::Rgba16Float, samples_, blends, "weighted light of blended hair");
        picture(TargetId::blendRest, Format::Rgba16Float, samples_, blends, "transmittance of blended hair");
        picture(TargetId::blendSumResolved, Format::Rgba16Float, 1, blends && samples_ > 1,
                "average of the samples");
        picture(TargetId::blendRestResolved, Format::Rgba16Float, 1, blends && samples_ > 1,
                "average of the samples");
    }

    void planOutput() {
        pass(Pass::accumulate, true,
             options_.frames > 1 ? fmt::format("averages {} frames", options_.frames)
                                 : "the frame is kept in single precision");
        buffer(BufferId::sum, pixels(), 16, true, "sum of the frames");
        planBlur();
        const bool filter = facts_.presents && options_.filter != PostFilter::none;
        pass(Pass::toneMap, facts_.presents,
             facts_.presents ? "exposure and tone curve" : "no target to show the image in");
        pass(Pass::filter, filter,
             filter            ? (options_.filter == PostFilter::fxaa ? "softens edges of the image"
                                                                      : "softens edges after a long search")
             : facts_.presents ? "no filter is selected"
                               : "no target to show the image in");
        picture(TargetId::shown, Format::Rgba8Unorm, 1, filter, "input of the filter");
    }

    void planBlur() {
        const bool shadows = runs(Pass::headDepth) || runs(Pass::firstHair) || runs(Pass::opacity);
        const bool on = shadows && options_.shadowBlur > 0;
        pass(Pass::shadowBlur, on,
             on ? fmt::format(
                      "blurs shadows by {} pixels and draws everything twice, with and without shadows",
                      options_.shadowBlur)
             : shadows ? "shadow blur is 0"
                       : "no shadows to blur");
        buffer(BufferId::litSum, pixels(), 16, on, "sum of the frames without shadows");
        buffer(BufferId::blurHalfway, 2 * pixels(), 16, on, "both sums, blurred along rows");
        buffer(BufferId::blurred, pixels(), 16, on, "the sum with blurred shadows");
    }

    void planOverlay() {
        const bool hidden = facts_.presents && facts_.overlay;
        const bool depth = hidden && facts_.meshes;
        pass(Pass::overlayDepth, hidden,
             depth    ? "the head occludes marks behind it"
             : hidden ? "marks without a surface to occlude them"
                      : "no such marks");
        pass(Pass::overlay, hidden, hidden ? "marks that the head occludes" : "no such marks");
        const bool top = facts_.presents && facts_.overlayOnTop;
        pass(Pass::overlayOnTop, top, top ? "marks on top of everything" : "no such marks");
        picture(TargetId::overlayDepth, Format::D32Float, 1, hidden, "depth of the head alone");
    }

    const SceneFacts& facts_;
    const RenderOptions& options_;
    std::uint32_t samples_;
    RenderPlan plan_;
};

}  // namespace

const char* passName(Pass pass) {
    constexpr std::array<const char*, kPassCount> kNames{
        "curves",      "head depth", "first hair", "opacity layers", "sky head depth", "sky first hair",
        "sky layers",  "sky seen",   "light grid", "shade",          "across",         "surface",
        "nearest",     "draw",       "blend",      "composite",      "accumulate",     "temporal",
        "shadow blur", "tone map",   "filter",     "overlay depth",  "overlay",        "overlay on top"};
    return kNames[static_cast<std::size_t>(pass)];
}

const char* targetName(TargetId target) {
    constexpr std::array<const char*, kTargetCount> kNames{"head depth",
                                                           "sky head depth",
                                                           "colour",
                                                           "resolved",
                                                           "depth",
                                                           "blend sum",
                                                           "blend rest",
                                                           "blend sum resolved",
                                                           "blend rest resolved",
                                                           "shown",
                                                           "overlay depth"};
    return kNames[static_cast<std::size_t>(target)];
}

const char* bufferName(BufferId buffer) {
    constexpr std::array<const char*, kBufferCount> kNames{"first hair",
                                                           "layer counts",
                                                           "opacity layers",
                                                           "fragment counts",
                                                           "light fragments",
                                                           "sky first hair",
                                                           "sky layer counts",
                                                           "sky layers",
                                                           "light cells",
                                                           "light sums",
                                                           "light grid",
                                                           "nearest",
                                                           "light",
                                                           "nearest hairs",
                                                           "light of nearest hairs",
                                                           "cover of nearest hairs",
                                                           "sum",
                                                           "sum without shadows",
                                                           "blur halfway",
                                                           "blurred",
                                                           "nearest surface",
                                                           "surface numbers",
                                                           "surface",
                                                           "history",
                                                           "other history",
                                                           "history pixels",
                                                           "other history pixels"};
    return kNames[static_cast<std::size_t>(buffer)];
}

std::uint64_t RenderPlan::bytes() const {
    const auto sum = [](const auto& all) {
        return std::accumulate(all.begin(), all.end(), std::uint64_t{0},
                               [](std::uint64_t bytes, const auto& one) { return bytes + one.bytes(); });
    };
    return sum(targets) + sum(buffers) + tables.bytes;
}

RenderPlan planRender(const SceneFacts& facts, const RenderOptions& options, std::uint32_t samples) {
    return Planner(facts, options, samples).plan();
}

}  // namespace hairloom::render
