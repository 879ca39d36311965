// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/plan.h"

#include <fmt/format.h>

#include <numeric>

namespace hairloom::render {
namespace {

using gpu::Format;

class Planner {
  public:
    Planner(const SceneFacts& facts, const RenderOptions& options, std::uint32_t samples)
        : facts_(facts), options_(options), samples_(samples) {}

    RenderPlan plan() {
        planShadows();
        planPicture();
        planOutput();
        planOverlay();
        return std::move(plan_);
    }

  private:
    void pass(Pass which, bool on, std::string why) {
        plan_.passes[static_cast<std::size_t>(which)] = {on, std::move(why)};
    }
    void atlas(TargetId which, Format format, bool wanted, std::string why) {
        if (!wanted) return;
        const std::uint32_t size = options_.shadowResolution;
        plan_.targets[static_cast<std::size_t>(which)] = {size * facts_.shadowLights, size, format, 1,
                                                          std::move(why)};
    }
    void picture(TargetId which, Format format, std::uint32_t samples, bool wanted, std::string why) {
        if (!wanted) return;
        plan_.targets[static_cast<std::size_t>(which)] = {options_.width, options_.height, format, samples,
                                                          std::move(why)};
    }

    void planShadows() {
        const bool cast = facts_.shadowLights > 0;
        const bool receivers = facts_.hair || facts_.meshes;
        const bool on = cast && receivers && options_.shadows != Shadows::none;
        const std::string off = options_.shadows == Shadows::none ? "shadows are turned off"
                                : !cast                           ? "no light casts shadows"
                                                                  : "nothing would receive them";
        const bool hair = on && facts_.hair;
        const bool layers = hair && options_.shadows != Shadows::absorption;
        const bool first = hair && options_.shadows != Shadows::opacityMaps;
        const std::string noHair = on ? "no hair to cast them" : off;
        pass(Pass::headDepth, on && facts_.meshes,
             !on ? off
             : facts_.meshes
                 ? fmt::format("the head shades hair and itself from {} lights", facts_.shadowLights)
                 : "no head to cast shadows");
        pass(Pass::firstHair, first,
             first  ? "depths in hair count from the first one that a light meets"
             : hair ? "fixed layers need no first depth"
                    : noHair);
        pass(Pass::opacity, layers,
             layers ? (options_.shadows == Shadows::deepOpacity
                           ? "hair is counted in three layers behind the first"
                           : "hair is counted in four layers at fixed depths")
             : hair ? "absorption takes hair to be spread evenly"
                    : noHair);
        atlas(TargetId::headDepth, Format::D32Float, on && facts_.meshes,
              "what the head hides from the lights");
        atlas(TargetId::firstHair, Format::D32Float, first, "where hair begins as seen from the lights");
        atlas(TargetId::opacity, Format::Rgba16Unorm, layers,
              options_.shadows == Shadows::deepOpacity ? "three layers and the depth they count from"
                                                       : "four layers");
    }

    void planPicture() {
        const bool blends = facts_.hair && options_.transparency == Transparency::weighted;
        pass(Pass::curves, facts_.hair,
             facts_.hair ? fmt::format("{} curve segments a segment of a strand", options_.subdivisions)
                         : "no hair");
        pass(Pass::shade, facts_.hair,
             facts_.hair ? fmt::format("{} lights, once a point of a curve; {}", facts_.lights,
                                       facts_.look ? "colour or absorption changes from place to place"
                                                   : "all of a material's hair looks the same")
                         : "no hair");
        pass(Pass::draw, true,
             blends ? "the head, and hair that covers whole samples" : "head, hair and background");
        pass(Pass::blend, blends, blends ? "fine hair blends in any order" : "no hair is blended by weights");
        pass(Pass::composite, blends, blends ? "blended hair goes over the head" : "nothing was blended");
        const std::string many =
            samples_ > 1 ? fmt::format("{} samples a pixel", samples_) : "one sample a pixel";
        picture(TargetId::colour, kColourFormat, samples_, true, "linear light, " + many);
        picture(TargetId::resolved, kColourFormat, 1, samples_ > 1, "the samples' average");
        picture(TargetId::depth, Format::D32Float, samples_, true, "what is in front, " + many);
        picture(TargetId::blendSum, Format::Rgba16Float, samples_, blends, "weighted light of blended hair");
        picture(TargetId::blendRest, Format::Rgba16Float, samples_, blends, "what blended hair lets through");
        picture(TargetId::blendSumResolved, Format::Rgba16Float, 1, blends && samples_ > 1,
                "the samples' average");
        picture(TargetId::blendRestResolved, Format::Rgba16Float, 1, blends && samples_ > 1,
                "the samples' average");
    }

    void planOutput() {
        pass(Pass::accumulate, true,
             options_.frames > 1 ? fmt::format("{} frames are averaged", options_.frames)
                                 : "the frame is kept in single precision");
        picture(TargetId::sum, Format::Rgba32Float, 1, true, "sum of the frames");
        const bool filter = facts_.presents && options_.filter != PostFilter::none;
        pass(Pass::toneMap, facts_.presents,
             facts_.presents ? "exposure and tone curve" : "no target to show the picture in");
        pass(Pass::filter, filter,
             filter            ? (options_.filter == PostFilter::fxaa ? "edges of the picture are softened"
                                                                      : "edges are softened after a long search")
             : facts_.presents ? "no filter is chosen"
                               : "no target to show the picture in");
        picture(TargetId::shown, Format::Rgba8Unorm, 1, filter, "what the filter reads");
    }

    void planOverlay() {
        const bool hidden = facts_.presents && facts_.overlay;
        const bool depth = hidden && facts_.meshes;
        pass(Pass::overlayDepth, hidden,
             depth    ? "the head hides marks behind it"
             : hidden ? "marks with nothing to hide them"
                      : "no such marks");
        pass(Pass::overlay, hidden, hidden ? "marks that the head hides" : "no such marks");
        const bool top = facts_.presents && facts_.overlayOnTop;
        pass(Pass::overlayOnTop, top, top ? "marks over everything" : "no such marks");
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
        "curves", "head depth",    "first hair", "opacity layers", "shade",
        "draw",   "blend",         "composite",  "accumulate",     "tone map",
        "filter", "overlay depth", "overlay",    "overlay on top"};
    return kNames[static_cast<std::size_t>(pass)];
}

const char* targetName(TargetId target) {
    constexpr std::array<const char*, kTargetCount> kNames{"head depth",
                                                           "first hair",
                                                           "opacity layers",
                                                           "colour",
                                                           "resolved",
                                                           "depth",
                                                           "blend sum",
                                                           "blend rest",
                                                           "blend sum resolved",
                                                           "blend rest resolved",
                                                           "sum",
                                                           "shown",
                                                           "overlay depth"};
    return kNames[static_cast<std::size_t>(target)];
}

std::uint64_t RenderPlan::bytes() const {
    return std::accumulate(targets.begin(), targets.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const PlannedTarget& t) { return sum + t.bytes(); });
}

RenderPlan planRender(const SceneFacts& facts, const RenderOptions& options, std::uint32_t samples) {
    return Planner(facts, options, samples).plan();
}

}  // namespace hairloom::render
