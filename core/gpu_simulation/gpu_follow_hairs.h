// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Follow hairs (runtime/follow.h) on a GPU: wisps whose radius grows with speed and root triangles, and
// blends of both, from guides that never leave the device. Agrees with runtime::FollowHairs within rounding.

#include <memory>
#include <span>

#include "core/gpu/device.h"
#include "hairloom/follow.h"

namespace hairloom::gpu_simulation {

/// Guides of one moment; buffers hold a float4 per point, guide after guide, as StrandEngine writes them.
struct FollowInput {
    gpu::BufferPtr positions_ws;
    gpu::BufferPtr velocities_ws;  ///< null for guides at rest
    /// Per guide, as runtime::GuideMotion has them; may be empty.
    std::span<const runtime::Quat> rootRotations_ws;
    /// In place of those rotations: two float4 a guide, the second the rotation, as GpuHead writes them.
    gpu::BufferPtr roots_ws = {};
};

class GpuFollowHairs {
  public:
    /// Errors: those of runtime::FollowHairs::make, what the device says, a device without these kernels.
    static Result<GpuFollowHairs> make(gpu::Device& device, const runtime::FollowView& view);
    GpuFollowHairs(GpuFollowHairs&&) noexcept;
    GpuFollowHairs& operator=(GpuFollowHairs&&) noexcept;
    ~GpuFollowHairs();

    std::uint32_t hairCount() const;
    std::uint32_t pointsPerHair() const;
    /// float4 per point, hair after hair; metres, world, w = 1.
    gpu::BufferPtr positions_ws() const;

    /// Records the hairs of this moment, outside a pass.
    void record(gpu::CommandList& list, const FollowInput& input);

  private:
    struct Impl;
    explicit GpuFollowHairs(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom::gpu_simulation
