// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Textures and buffers that the passes write.

#include "core/gpu/device.h"
#include "core/render/plan.h"

namespace hairloom::render {

class Targets {
  public:
    struct New {
        std::array<bool, kTargetCount> textures{};
        std::array<bool, kBufferCount> buffers{};

        bool has(TargetId id) const { return textures[static_cast<std::size_t>(id)]; }
        bool has(BufferId id) const { return buffers[static_cast<std::size_t>(id)]; }
    };

    /// Makes what the plan has and is missing or has another size, lets go what the plan has not. Returns
    /// what is new.
    Result<New> fit(gpu::Device& device, const RenderPlan& plan);

    const gpu::TexturePtr& operator[](TargetId id) const { return textures_[static_cast<std::size_t>(id)]; }
    const gpu::BufferPtr& operator[](BufferId id) const { return buffers_[static_cast<std::size_t>(id)]; }
    /// What the frame has drawn, one sample a pixel.
    const gpu::TexturePtr& frame() const {
        return (*this)[TargetId::resolved] != nullptr ? (*this)[TargetId::resolved]
                                                      : (*this)[TargetId::colour];
    }

  private:
    std::array<gpu::TexturePtr, kTargetCount> textures_;
    std::array<gpu::BufferPtr, kBufferCount> buffers_;
};

}  // namespace hairloom::render
