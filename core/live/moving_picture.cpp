// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/moving_picture.h"

#include <algorithm>
#include <utility>

#include "core/render/plan.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kShadowResolution = 512, kSkyStrands = 1024;
constexpr float kDetail = 0.5f;

}  // namespace

void simplifyWhileMoving(render::RenderOptions& options) {
    options.frames = 1;
    options.samples = 1;
    options.subdivisions = 1;
    options.shadowResolution = std::min(kShadowResolution, options.shadowResolution);
    options.shadowBlur = 0;
    options.skyStrands = kSkyStrands;
    options.detail = kDetail;
    options.bakeBehind = true;
}

void takeWaysOfSoftware(render::RenderOptions& options) {
    constexpr std::uint32_t kMostSkyStrands = 2048;
    using render::Transparency;
    if (options.transparency == Transparency::automatic || options.transparency == Transparency::weighted)
        options.transparency = Transparency::sorted;
    options.ribbons = render::Ribbons::compute;
    if (options.samples == 0) options.samples = 4;
    options.skyStrands = std::min(options.skyStrands, kMostSkyStrands);
}

std::string_view frameCostName(FrameCost cost) {
    switch (cost) {
        case FrameCost::head:
            return "head";
        case FrameCost::solve:
            return "solve";
        case FrameCost::hairHair:
            return "hair-hair";
        case FrameCost::follow:
            return "followHairs";
        case FrameCost::measures:
            return "measures";
        case FrameCost::shadow:
            return "shadow";
        case FrameCost::shade:
            return "shade";
        case FrameCost::draw:
            break;
    }
    return "draw";
}

bool isSimulationCost(FrameCost cost) {
    return cost != FrameCost::shadow && cost != FrameCost::shade && cost != FrameCost::draw;
}

FrameCost frameCostOf(std::string_view pass) {
    using render::Pass;
    using render::passName;
    static constexpr std::pair<std::string_view, FrameCost> kSimulation[] = {
        {"head", FrameCost::head},
        {"roots", FrameCost::head},
        {"roots of slots", FrameCost::solve},
        {"strands", FrameCost::solve},
        {"hair-hair collision", FrameCost::hairHair},
        {"wisps", FrameCost::follow},
        {"follow hairs", FrameCost::follow},
        {"hair out of the body", FrameCost::follow},
        {"measures", FrameCost::measures},
        {"extent", FrameCost::measures},
    };
    const auto* const found =
        std::ranges::find(kSimulation, pass, &std::pair<std::string_view, FrameCost>::first);
    if (found != std::end(kSimulation)) return found->second;
    for (const Pass shadow : {Pass::headDepth, Pass::firstHair, Pass::opacity, Pass::skyHead, Pass::skyFirst,
                              Pass::skyLayers, Pass::skySeen}) {
        if (pass == passName(shadow)) return FrameCost::shadow;
    }
    for (const Pass shade : {Pass::shade, Pass::curves}) {
        if (pass == passName(shade)) return FrameCost::shade;
    }
    return FrameCost::draw;
}

}  // namespace hairloom
