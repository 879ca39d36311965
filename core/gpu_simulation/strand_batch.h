// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands as the kernels want them: batches of alike point counts, strand-major, each with its own slots
// (runtime/engine/slots.h).

#include <optional>
#include <vector>

#include "core/gpu/device.h"
#include "core/gpu_simulation/kernel_key.h"
#include "runtime/engine/slots.h"

namespace hairloom::gpu_simulation {

struct LayoutOptions {
    /// Absent: what was measured to be fastest for as many strands.
    std::optional<StrandStorage> storage = {};
    bool unroll = true;  ///< where all strands of a batch have as many points, up to 32
    /// Strands of a work group of StrandStorage::lanes, a power of 2 up to 32, as far as 256 threads hold
    /// them; absent: those that fill its waves.
    std::optional<std::uint32_t> groupStrands = {};
    /// Points of a thread of StrandStorage::lanes, 1 or 2, where a strand has an even number of them, 8 or
    /// more; absent: what was measured to be fastest for as many strands.
    std::optional<std::uint32_t> perThread = {};
    /// Threads of StrandStorage::lanes read each other's registers, where a work group is made of waves that
    /// the device has and each holds whole strands; else they use the memory of the group.
    bool waves = true;
    /// Threads that share a rod, 1 to 16; absent: what was measured to be fastest for as many strands.
    /// Direct3D 11 has 1.
    std::optional<std::uint32_t> members = {};
};

/// For such a device.
LayoutOptions layoutFor(gpu::DeviceType type);

/// A buffer of a model of strands, for its kernel; null while the effect is off.
struct ModelBuffer {
    std::uint32_t slot = 0;
    runtime::Effect effect = runtime::Effect::angular;  ///< that it exists for
    gpu::BufferPtr buffer;
};
struct ModelBuffers {
    std::vector<ModelBuffer> read;
    ModelBuffer state;  ///< written: what the model remembers from step to step beside StrandBatch::state

    /// What is read at a slot; null: nothing.
    gpu::BufferPtr at(std::uint32_t slot) const;
};

/// Of StrandBatch::state: those of runtime::State, and what a model keeps there (springs: the tension).
inline constexpr std::size_t kDevicePlanes = runtime::kStatePlanes + 1;

struct StrandBatch {
    BatchShape shape;
    std::vector<std::uint32_t> blocks;  ///< of the rest shape
    std::uint32_t slots = 0;
    // Made with the batch; names as in runtime/shaders/storage.hlsli.
    gpu::BufferPtr rest, segments, blockCounts, firstPoints, rootsTo, state, roots;
    gpu::BufferPtr strandOfSlot;  ///< once the device finds roots itself
    // Null while what needs them is off.
    gpu::BufferPtr rests, gathered, scratch;
    /// Metres from the body at rest of each point; null without one. Rods keep more of their state then.
    gpu::BufferPtr clearances;
    ModelBuffers model;
    KernelKey key;
    gpu::ComputePipelinePtr kernel;

    runtime::Slots inSlots() const { return {blocks, shape.points, slots, shape.together}; }
};

/// Without buffers. Few point counts have a batch each; many share batches of 4, 8, … points.
std::vector<StrandBatch> makeBatches(const runtime::RestShape& shape, const LayoutOptions& options,
                                     const gpu::WaveSizes& waves);

/// Makes the buffers that hold the rest shape.
Status makeRestBuffers(gpu::Device& device, const runtime::RestShape& shape, StrandBatch& batch);

/// A structured buffer of T. `content` may be empty, then it has `count` elements of no known value.
template <class T>
Result<gpu::BufferPtr> makeBuffer(gpu::Device& device, const char* name, gpu::Usage usage, std::size_t count,
                                  std::span<const T> content) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = count * sizeof(T);
    desc.usage = usage;
    desc.elementBytes = sizeof(T);
    return device.createBuffer(desc, std::as_bytes(content));
}

/// Has a buffer of `count` floats that are 0, or none; whether it is new.
Result<bool> haveFloats(gpu::Device& device, gpu::BufferPtr& buffer, const char* name, std::size_t count,
                        std::uint32_t elementBytes);

template <class T, class A>
std::span<const std::byte> bytesOfVector(const std::vector<T, A>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace hairloom::gpu_simulation
