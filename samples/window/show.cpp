// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/window/show.h"

#include "core/live/moving_picture.h"

namespace hairloom::window {
namespace {

constexpr float kFrame = 1.0f / 60.0f;  // seconds

Groom inWind(Groom groom, float windSpeed) {
    groom.simulation.windSpeed = windSpeed;
    return groom;
}

}  // namespace

Result<std::unique_ptr<Show>> Show::make(gpu::Device& device, const Window& window, const Groom& calm,
                                         float windSpeed, EngineWish wish) {
    const Groom groom = inWind(calm, windSpeed);
    auto motion = makeRigidMotion("spin", groom);
    if (!motion) return tl::unexpected(motion.error());
    auto scene = GroomScene::make(groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    const auto kernels =
        std::make_shared<gpu_simulation::KernelLibrary>(device, gpu_simulation::userKernelFolder());
    EngineChoice engine = chooseEngine(wish, &device, kernels, groom, EngineMemory::ofUser());
    auto hair =
        MovingHair::make(engine.kind, device, kernels, *scene, (*motion)->skin(), {(*motion)->poseAt(0)});
    if (!hair) return tl::unexpected(hair.error());
    std::unique_ptr<Show> show(new Show(window, std::move(*motion), std::move(*scene), std::move(*hair),
                                        std::move(engine), render::Renderer(device)));
    if (auto status = show->openSwapChain(device); !status) return tl::unexpected(status.error());
    return show;
}

Status Show::openSwapChain(gpu::Device& device) {
    device_ = &device;
    size_ = window_.size();
    auto chain = device.createSwapChain({window_.native(), size_.width, size_.height, true});
    if (!chain) return tl::unexpected(chain.error());
    chain_ = std::move(*chain);
    render::RenderScene scene = scene_.scene();
    scene.camera = render::frame(render::View::ThreeQuarter, scene_.subject(), 1.0f);
    scene.lights = render::studioLights(scene.camera);
    return renderer_.setScene(scene);
}

Status Show::followWindow() {
    const Size now = window_.size();
    if (now == size_ || now.width == 0 || now.height == 0) return {};
    size_ = now;
    return chain_->resize(now.width, now.height);
}

Status Show::showNext() {
    if (auto status = followWindow(); !status) return status;
    render::RenderOptions options;
    options.width = size_.width;
    options.height = size_.height;
    simplifyWhileMoving(options);  // as the editor's viewport does
    options.temporal = true;
    auto list = device_->createCommandList();
    if (!list) return tl::unexpected(list.error());
    if (auto status = hair_.step(**list, kFrame, *motion_); !status) return status;
    if (auto status = hair_.show(renderer_, scene_); !status) return status;
    if (auto status = renderer_.record(**list, options, chain_->backBuffer()); !status) return status;
    auto submission = device_->submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    hair_.submitted(*submission);
    // The device works on one picture while the next is recorded.
    if (last_) {
        if (auto status = last_->wait(); !status) return status;
    }
    last_ = std::move(*submission);
    return chain_->present();
}

}  // namespace hairloom::window
