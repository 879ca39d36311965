// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that plays on the device that draws it, and what that takes. Used on the render thread only.

#include "core/live/moving_hair.h"

namespace hairloom::editor {

class PlayedHair {
  public:
    /// `device` outlives it.
    explicit PlayedHair(gpu::Device& device) : device_(device) {}

    EngineChoice choose(EngineWish wish, const Groom& groom) {
        return chooseEngine(wish, &device_, kernels(), groom, EngineMemory::ofUser());
    }
    /// In place of what played. Errors: as for MovingHair; nothing plays then.
    Status start(std::shared_ptr<const Groom> groom, const SkinWeights* skin, const MovingStart& start) {
        stop();
        const auto scene = GroomScene::make(*groom, {}, {});
        if (!scene) return tl::unexpected(scene.error());
        auto made = MovingHair::onGpu(device_, kernels(), *scene, skin, start);
        if (!made) return tl::unexpected(made.error());
        hair_.emplace(std::move(*made));
        groom_ = std::move(groom);
        return {};
    }
    void stop() { hair_.reset(); }

    /// Null: nothing plays.
    MovingHair* hair() { return hair_ ? &*hair_ : nullptr; }
    /// For a picture of this groom; null where other hairs play.
    MovingHair* hairOf(const Groom& groom) {
        return hair_ && drawSameHairs(groom, *groom_) ? &*hair_ : nullptr;
    }

  private:
    const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels() {
        using gpu_simulation::KernelLibrary;
        if (!kernels_)
            kernels_ = std::make_shared<KernelLibrary>(device_, gpu_simulation::userKernelFolder());
        return kernels_;
    }

    gpu::Device& device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
    std::optional<MovingHair> hair_;
    std::shared_ptr<const Groom> groom_;  ///< of hair_
};

}  // namespace hairloom::editor
