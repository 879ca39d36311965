// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hairstyle that turns in the wind, simulated on the CPU or where it is drawn, through a swap chain.

#include <memory>
#include <optional>

#include "core/gpu/device.h"
#include "core/live/moving_hair.h"
#include "core/render/renderer.h"
#include "samples/window/window.h"

namespace hairloom::window {

class Show {
  public:
    /// `groom` turns once a second, in wind of `windSpeed` m/s. Device and window outlive it. Errors: as for
    /// swap chains, simulations and scenes.
    static Result<std::unique_ptr<Show>> make(gpu::Device& device, const Window& window, const Groom& groom,
                                              float windSpeed, EngineWish wish);
    const EngineChoice& engine() const { return engine_; }

    /// Moves the hair on by a sixtieth of a second and shows the picture, at the size that the window has.
    Status showNext();

  private:
    Show(const Window& window, std::unique_ptr<HeadMotion> motion, GroomScene scene, MovingHair hair,
         EngineChoice engine, render::Renderer renderer)
        : window_(window),
          motion_(std::move(motion)),
          scene_(std::move(scene)),
          hair_(std::move(hair)),
          engine_(std::move(engine)),
          renderer_(std::move(renderer)) {}
    Status openSwapChain(gpu::Device& device);
    Status followWindow();

    const Window& window_;
    gpu::Device* device_ = nullptr;
    std::unique_ptr<HeadMotion> motion_;
    GroomScene scene_;
    MovingHair hair_;
    EngineChoice engine_;
    render::Renderer renderer_;
    std::unique_ptr<gpu::SwapChain> chain_;
    gpu::SubmissionPtr last_;
    Size size_;
};

}  // namespace hairloom::window
