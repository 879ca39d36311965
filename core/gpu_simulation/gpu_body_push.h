// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Keeps hair that is drawn out of a body (hairloom/body_push.h) on a GPU.

#include "core/gpu_simulation/device_body.h"
#include "hairloom/body_push.h"

namespace hairloom::gpu_simulation {

class GpuBodyPush {
  public:
    /// For the hairs of `push`. Errors: what the device says, a device without this kernel.
    static Result<GpuBodyPush> make(gpu::Device& device, const runtime::BodyPush& push);

    /// Records what BodyPush::apply() does, outside a pass. `body`: in the pose of the end of its last frame;
    /// `points_ws`: a float4 per point, hair after hair.
    void record(gpu::CommandList& list, const DeviceBody& body, const gpu::BufferPtr& points_ws) const;

  private:
    std::uint32_t hairs_ = 0, points_ = 0;
    gpu::BufferPtr offsets_, hairOfPoint_, least_, leastBetween_, marks_, flags_;
    gpu::ComputePipelinePtr pointsOut_, look_, curvesOut_;
};

}  // namespace hairloom::gpu_simulation
