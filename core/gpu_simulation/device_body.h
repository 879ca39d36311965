// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A body (hairloom/body_field.h) that rods on a GPU meet, as runtime::Engine has it on the CPU.

#include <memory>
#include <string>
#include <vector>

#include "core/gpu/device.h"
#include "runtime/engine/body_gpu.h"
#include "runtime/engine/moving_body.h"
#include "runtime/engine/state.h"

namespace hairloom::gpu_simulation {

/// Whether such a device has kernels that keep hair out of a body.
bool hasBodyKernels(const gpu::DeviceInfo& info);
/// Empty, or why strands of these settings cannot meet `body` there; null: there is none.
std::string bodyError(const gpu::DeviceInfo& info, const runtime::SimulationSettings& settings,
                      const runtime::BodyField* body);

class DeviceBody {
  public:
    /// `shape`: of the strands that meet it. Errors: BodyField::problem(), what the device says.
    static Result<DeviceBody> make(gpu::Device& device, std::shared_ptr<const runtime::BodyField> body,
                                   const runtime::RestShape& shape);

    /// Poses it for the substeps of a frame, of whose input it takes body_ws; whether it moves. What comes
    /// farther than `teleportDistance` is carried along.
    bool takeFrame(const runtime::FrameInput& input, float teleportDistance, std::uint32_t substeps);
    /// There is no pose before the first frame that gives one: nothing is met.
    bool hasPose() const { return !pose_.empty(); }
    /// At the end of the last frame; as many bones as the input had.
    const runtime::Vector<runtime::BonePose>& pose() const { return pose_; }
    /// The next frame begins there; empty: where it ends.
    void setPose(const runtime::Vector<runtime::BonePose>& pose) { pose_ = pose; }
    void moveOrigin(runtime::Float3 shift);
    /// Sends the poses of the frame.
    Status upload(gpu::CommandList& list);

    /// For kernels that include body.hlsli, inside a pass: at the end of the frame their step is `steps`.
    void bind(std::vector<gpu::Binding>& bindings) const;
    void setConstants(gpu::CommandList& list) const { list.setConstants(3, gpu::bytesOf(constants_)); }
    std::size_t bytes() const;

  private:
    explicit DeviceBody(gpu::Device& device) : device_(&device) {}

    gpu::Device* device_;
    std::shared_ptr<const runtime::BodyField> field_;
    std::unique_ptr<runtime::BodyTable> cpuTable_;  ///< that moving_ refers to
    runtime::Vector<std::uint32_t> carriers_;
    runtime::MovingBody moving_;
    runtime::Vector<runtime::BonePose> pose_;
    runtime::Vector<shaders::float4> rows_;
    shaders::BodyConstants constants_{};
    gpu::BufferPtr table_, poses_;
};

}  // namespace hairloom::gpu_simulation
