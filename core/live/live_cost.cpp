// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/live_cost.h"

#include "core/base/stopwatch.h"
#include "core/gpu/frames_under_way.h"
#include "core/live/moving_picture.h"
#include "core/live/picture_shadows.h"

namespace hairloom {
namespace {

constexpr float kFrame = 1.0f / 60;             // seconds
constexpr std::uint32_t kWarmUp = 8;            ///< frames, until a GPU is at speed
constexpr std::uint32_t kWarmUpOfSoftware = 1;  ///< which compiles its shaders
constexpr std::size_t kUnderWay = 2;            // frames

/// As the viewport draws while something moves.
render::RenderOptions viewportOptions(std::uint32_t width, std::uint32_t height) {
    render::RenderOptions options;
    options.width = width;
    options.height = height;
    simplifyWhileMoving(options);
    options.temporal = true;
    options.transparency = render::Transparency::automatic;
    return options;
}

}  // namespace

struct LiveLoop::Stage {
    GroomScene scene;
    const HeadMotion& motion;
    MovingHair hair;
};

LiveLoop::LiveLoop(gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                   std::uint32_t width, std::uint32_t height)
    : device_(device),
      kernels_(std::move(kernels)),
      options_(viewportOptions(width, height)),
      renderer_(device) {}

Result<LiveCost> LiveLoop::run(const Groom& groom, const HeadMotion& motion, EngineKind engine,
                               std::uint32_t frames) {
    takeShadows(groom.shadows, options_);
    simplifyWhileMoving(options_);
    auto scene = GroomScene::make(groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    auto hair = MovingHair::make(engine, device_, kernels_, *scene, motion.skin(), {motion.poseAt(0)});
    if (!hair) return tl::unexpected(hair.error());
    Stage stage{std::move(*scene), motion, std::move(*hair)};
    if (auto status = setUp(stage.scene); !status) return tl::unexpected(status.error());
    const bool software = device_.info().type == gpu::DeviceType::Cpu;
    if (auto status = play(stage, software ? kWarmUpOfSoftware : kWarmUp); !status)
        return tl::unexpected(status.error());
    cost_ = {};
    const gpu::Traffic before = device_.traffic();
    const Stopwatch watch;
    if (auto status = play(stage, frames); !status) return tl::unexpected(status.error());
    cost_.wall = 1e3 * watch.seconds();
    const gpu::Traffic after = device_.traffic();
    cost_.toDevice = static_cast<double>(after.toDevice - before.toDevice);
    cost_.fromDevice = static_cast<double>(after.fromDevice - before.fromDevice);
    for (double* sum : {&cost_.simulate, &cost_.follow, &cost_.shadow, &cost_.shade, &cost_.draw, &cost_.wall,
                        &cost_.toDevice, &cost_.fromDevice})
        *sum /= frames;
    for (auto& [name, milliseconds] : cost_.passes) milliseconds /= frames;
    const render::RenderScene drawn = stage.scene.scene();
    cost_.hairs = drawn.strands.front().offsets.size() - 1;
    cost_.pointBytes = static_cast<double>(drawn.strands.front().positions_ws.size_bytes());
    return cost_;
}

Status LiveLoop::setUp(const GroomScene& groom) {
    render::RenderScene scene = groom.scene();
    const float aspect = static_cast<float>(options_.width) / static_cast<float>(options_.height);
    scene.camera = render::frame(render::View::ThreeQuarter, groom.subject(), aspect);
    scene.lights = render::studioLights(scene.camera);
    gpu::TextureDesc desc;
    desc.name = "bench";
    desc.width = options_.width;
    desc.height = options_.height;
    desc.usage = gpu::Usage::RenderTarget;
    auto target = device_.createTexture(desc);
    if (!target) return tl::unexpected(target.error());
    target_ = std::move(*target);
    return renderer_.setScene(scene);
}

Status LiveLoop::play(Stage& stage, std::uint32_t count) {
    MovingHair& hair = stage.hair;
    gpu::FramesUnderWay underWay(kUnderWay, [this](const auto& times) { add(times); });
    for (std::uint32_t frame = 0; frame < count; ++frame) {
        auto list = device_.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (auto status = hair.step(**list, kFrame, stage.motion); !status) return status;
        if (auto status = hair.show(renderer_, stage.scene); !status) return status;
        if (auto status = renderer_.record(**list, options_, target_); !status) return status;
        auto submission = device_.submit(std::move(*list));
        if (!submission) return tl::unexpected(submission.error());
        hair.submitted(*submission);
        cost_.simulate += hair.simulateMilliseconds();
        cost_.follow += hair.followMilliseconds();
        if (auto status = underWay.add(std::move(*submission)); !status) return status;
    }
    return underWay.finish();
}

void LiveLoop::add(const std::vector<gpu::PassTime>& times) {
    for (const gpu::PassTime& time : times) {
        sumOf(time.name) += time.milliseconds;
        cost_.passes[time.name] += time.milliseconds;
    }
}

double& LiveLoop::sumOf(std::string_view pass) {
    switch (frameCostOf(pass)) {
        case FrameCost::head:
        case FrameCost::solve:
        case FrameCost::hairHair:
        case FrameCost::measures:
            return cost_.simulate;
        case FrameCost::follow:
            return cost_.follow;
        case FrameCost::shadow:
            return cost_.shadow;
        case FrameCost::shade:
            return cost_.shade;
        case FrameCost::draw:
            break;
    }
    return cost_.draw;
}

}  // namespace hairloom
