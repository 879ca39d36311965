// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands as the kernels want them: batches of alike point counts, strand-major. A slot is a strand's place
// in its batch; 32 of them are a block of runtime::RestShape and a work group. Slots past the strands of a
// block repeat its last.

#include <functional>
#include <optional>
#include <vector>

#include "core/gpu/device.h"
#include "core/gpu_simulation/kernel_key.h"
#include "runtime/engine/state.h"
#include "runtime/shaders/types.h"

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

/// Of StrandBatch::state: those of runtime::State, and what is kept of the tension.
inline constexpr std::size_t kDevicePlanes = runtime::kStatePlanes + 1;

struct StrandBatch {
    BatchShape shape;
    std::vector<std::uint32_t> blocks;  ///< of the rest shape
    std::uint32_t slots = 0;
    // Made with the batch; names as in runtime/shaders/storage.hlsli.
    gpu::BufferPtr rest, segments, blockCounts, firstPoints, rootsTo, state, roots;
    gpu::BufferPtr strandOfSlot;  ///< once the device finds roots itself
    // Null while what needs them is off.
    gpu::BufferPtr bend, targets, rests, gathered, scratch;
    // Of rods, as in runtime/shaders/rod_storage.hlsli; null for springs.
    gpu::BufferPtr rodRest, rodMasses, curvedBlocks, rodState;
    KernelKey key;
    gpu::ComputePipelinePtr kernel;
};

/// Without buffers. Few point counts have a batch each; many share batches of 4, 8, … points.
std::vector<StrandBatch> makeBatches(const runtime::RestShape& shape, const LayoutOptions& options,
                                     const gpu::WaveSizes& waves);

/// Calls visit(block, point, index of lane 0 in a plane of that block, index of its slot in a plane of the
/// batch) for each row of kBlockLanes strands. From lane to lane the latter grows by laneStride(batch).
void forEachRow(const runtime::RestShape& shape, const StrandBatch& batch,
                const std::function<void(std::size_t block, std::uint32_t point, std::size_t inBlock,
                                         std::size_t inBatch)>& visit);

inline std::size_t laneStride(const StrandBatch& batch) {
    return batch.shape.together ? batch.shape.points : 1;
}

/// Planes of blocks as those of a batch, plane after plane. `planes` holds `count` of them per block.
std::vector<float> planesOfBatch(const runtime::RestShape& shape, const StrandBatch& batch,
                                 const runtime::Floats& planes, std::size_t count);
/// The reverse.
void planesOfBlocks(const runtime::RestShape& shape, const StrandBatch& batch, std::span<const float> values,
                    runtime::Floats& planes, std::size_t count);
/// Rows of one value per slot in the order of blocks: `rows` of them a block.
void rowsToBlocks(const StrandBatch& batch, std::span<const float> values, std::size_t rows, float* blocks);
/// The reverse.
std::vector<float> rowsOfBatch(const StrandBatch& batch, const float* blocks, std::size_t rows);
/// Up to four of the planes of each block, as the components of a float4 for each point.
std::vector<shaders::float4> quadsOfBatch(const runtime::RestShape& shape, const StrandBatch& batch,
                                          const runtime::Floats& planes, std::size_t count,
                                          std::span<const std::size_t> which);

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

}  // namespace hairloom::gpu_simulation
