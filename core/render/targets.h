// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Textures that the passes draw into.

#include "core/gpu/device.h"
#include "core/render/plan.h"

namespace hairloom::render {

class Targets {
  public:
    /// Makes what the plan has and is missing or has another size, lets go what the plan has not. Returns
    /// which textures are new.
    Result<std::array<bool, kTargetCount>> fit(gpu::Device& device, const RenderPlan& plan);

    const gpu::TexturePtr& operator[](TargetId id) const { return textures_[static_cast<std::size_t>(id)]; }
    /// What the frame has drawn, one sample a pixel.
    const gpu::TexturePtr& frame() const {
        return (*this)[TargetId::resolved] != nullptr ? (*this)[TargetId::resolved]
                                                      : (*this)[TargetId::colour];
    }

  private:
    std::array<gpu::TexturePtr, kTargetCount> textures_;
};

}  // namespace hairloom::render
