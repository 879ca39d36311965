// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair against hair through a volume (runtime/alternatives/hair_volume.h) between the frames of strands on a
// GPU. The grid is laid out on the device, from the box of the points there.
//
// Differs from the runtime's: positions and pressures are in single precision, and velocities of a sum are
// whole numbers of up to 23 bits; sums are exact and equal in any order all the same.

#include <array>
#include <span>

#include "core/gpu_simulation/strand_batch.h"
#include "hairloom/alternatives/hair_volume.h"

namespace hairloom::gpu_simulation {

class GpuHairVolume {
  public:
    /// Errors: a setting outside its range, what the device says.
    static Result<GpuHairVolume> make(gpu::Device& device, const runtime::HairVolumeSettings& settings);

    /// Records the change of velocities that a frame of `dt` seconds, whose substeps took `h`, gives the
    /// strands.
    void record(gpu::CommandList& list, std::span<const StrandBatch> batches, std::uint32_t clampedPoints,
                float dt, float h) const;
    std::size_t bytes() const;

  private:
    explicit GpuHairVolume(const runtime::HairVolumeSettings& settings) : settings_(settings) {}
    Status makeBuffers(gpu::Device& device);
    Status makeKernels(gpu::Device& device);

    runtime::HairVolumeSettings settings_;
    gpu::BufferPtr box_, nodes_, fields_;
    std::array<gpu::BufferPtr, 2> nothing_;  // stands for what a batch has not
    gpu::ComputePipelinePtr measure_, clear_, add_, resolve_, push_;
};

}  // namespace hairloom::gpu_simulation
