// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hairstyle that turns in the wind: the simulation on the CPU, the picture through a swap chain.

#include <memory>
#include <optional>

#include "core/gpu/device.h"
#include "core/render/renderer.h"
#include "core/scene/groom_scene.h"
#include "core/simulation/simulation.h"
#include "samples/window/window.h"

namespace hairloom::window {

class Show {
  public:
    /// `groom` turns once a second, in wind of `windSpeed` m/s. Device and window outlive it. Errors: as for
    /// swap chains, simulations and scenes.
    static Result<std::unique_ptr<Show>> make(gpu::Device& device, const Window& window, const Groom& groom,
                                              float windSpeed);

    /// Moves the hair on by a sixtieth of a second and shows the picture, at the size that the window has.
    Status showNext();

  private:
    Show(const Window& window, Simulation simulation, std::unique_ptr<HeadMotion> motion, GroomScene scene,
         render::Renderer renderer)
        : window_(window),
          simulation_(std::move(simulation)),
          motion_(std::move(motion)),
          scene_(std::move(scene)),
          renderer_(std::move(renderer)) {}
    Status openSwapChain(gpu::Device& device);
    Status followWindow();
    Status moveHair();

    const Window& window_;
    gpu::Device* device_ = nullptr;
    Simulation simulation_;
    std::unique_ptr<HeadMotion> motion_;
    GroomScene scene_;
    render::Renderer renderer_;
    std::unique_ptr<gpu::SwapChain> chain_;
    gpu::SubmissionPtr last_;
    Size size_;
    std::uint64_t pictures_ = 0;
};

}  // namespace hairloom::window
