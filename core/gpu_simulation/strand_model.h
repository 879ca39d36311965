// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a model of strands (runtime/engine/strand_model.h) adds on a GPU: what its kernel is made for, and its
// buffers. A model is a file of models/ and a line of models/models.cpp. Nothing else here knows one.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gpu_simulation/strand_batch.h"
#include "runtime/engine/strand_model.h"

namespace hairloom::gpu_simulation {

/// The strands of one engine as their model has them on the device.
class DeviceStrands {
  public:
    virtual ~DeviceStrands() = default;

    /// Takes other settings: fills ModelBuffers of each batch as far as they follow from settings alone.
    virtual Status takeSettings(gpu::Device& device, const runtime::RestShape& shape,
                                const runtime::SimulationSettings& settings,
                                std::span<StrandBatch> batches) = 0;
    /// As ModelStrands::takePoses(); after takeSettings().
    virtual void takePoses(const runtime::RestShape&, const runtime::SimulationSettings&,
                           const runtime::PoseChange&) {}
    /// Between frames; both plans ran or will.
    virtual void changePlan(const runtime::EffectPlan&, const runtime::EffectPlan&) {}
    /// Has the other ModelBuffers that the batch's key needs, and no others.
    virtual Status allocate(gpu::Device&, StrandBatch&) { return {}; }

    /// Once a frame, before its kernels: sends what depends on the substep of h seconds.
    virtual void upload(gpu::CommandList&, const runtime::RestShape&, const runtime::EffectPlan&,
                        const runtime::SimulationSettings&, float, std::span<const StrandBatch>) {}
    /// Before the kernel of each batch. `before`: seconds of the last substep, 0 before the first.
    virtual void setConstants(gpu::CommandList&, const runtime::SubstepContext&, const runtime::Wind&, float,
                              const StrandBatch&) const {}
    virtual void closeFrame() {}

    /// Gives a state its arrays of State::own.
    virtual void allocateState(const runtime::RestShape& shape, const runtime::EffectPlan& plan,
                               runtime::State& state) const = 0;
    /// Puts lanes of block `index` at rest on their roots; their points are there.
    virtual void placeAtRest(const runtime::RestShape&, runtime::State&, std::size_t,
                             runtime::LaneRange) const {}
    /// The device gets this state: none where it is one of this model, else as one of it.
    virtual std::optional<runtime::State> takeState(const runtime::RestShape&, const runtime::State&) {
        return {};
    }
    /// Between StrandBatch::state (`moving`) and ModelBuffers::state (`own`), both as read from the device,
    /// and State::own.
    virtual void readOwn(const runtime::RestShape& shape, const StrandBatch& batch,
                         std::span<const float> moving, std::span<const float> own,
                         runtime::State& state) const = 0;
    /// `moving` has kStatePlanes planes and may get another, `own` is empty.
    virtual void writeOwn(const runtime::RestShape& shape, const StrandBatch& batch,
                          const runtime::State& state, runtime::Vector<float>& moving,
                          runtime::Vector<float>& own) const = 0;
};

struct GpuModel {
    /// Fills KernelKey::own, and changes what the model has otherwise; the rest is filled.
    void (*fillKey)(const runtime::EffectPlan& plan, const runtime::SimulationSettings& settings,
                    KernelKey& key);
    std::string (*defines)(const KernelKey& key);
    /// Floats of each point that a kernel of StrandStorage::buffers works in.
    std::size_t (*scratchPlanes)(const KernelKey& key);
    /// Where velocities are written to.
    std::uint32_t (*velocitySlot)(const KernelKey& key);
    /// Where work groups of a block that fall asleep as one leave what they have seen.
    std::uint32_t gatheredSlot;
    /// As kernelError().
    std::string (*error)(const runtime::SimulationSettings& settings);
    /// What strands are in where nobody asks for another; none: as LayoutOptions says.
    std::optional<StrandStorage> storage;
    std::unique_ptr<DeviceStrands> (*make)();
};
const GpuModel& gpuModelOf(runtime::StrandModel model);

}  // namespace hairloom::gpu_simulation
