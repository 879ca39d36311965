// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/strand_batch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include "runtime/shaders/simulation_types.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::kBlockLanes;

static_assert(kBlockLanes == HAIRLOOM_GROUP_STRANDS);

/// Longer strands stay in buffers: the memory of all threads together would be too much.
constexpr std::uint32_t kMaxInThreads = 64;
constexpr std::uint32_t kMaxUnrolled = 32;
/// Of position and previous of a group, within the 32 KiB that every device has.
constexpr std::uint32_t kMaxInGroups = 32 * 1024 / (6 * sizeof(float) * kBlockLanes);
/// More different point counts than this share batches.
constexpr std::size_t kMaxExact = 3;
constexpr std::uint32_t kMinShared = 4;
/// Four threads sample the wind.
constexpr std::uint32_t kMinInLanes = 4, kMinInPairs = 2 * kMinInLanes;
/// Blocks of strands from which on a thread for each strand is faster: docs/gpu-simulation.md, "What it
/// costs".
constexpr std::size_t kMaxBlocksInLanes = 100'000 / kBlockLanes;
/// Blocks of strands up to which lanes have a point each, and not two: as measured there.
constexpr std::size_t kMaxBlocksOfOne = 4'000 / kBlockLanes;

/// Blocks of rods up to which some threads share a strand, and how many: docs/performance.md, "On a GPU".
constexpr std::size_t kMaxBlocksOfMembers = 12'000 / kBlockLanes;
constexpr std::uint32_t kMembers = 16;

/// Of lanes: the memory of a group of more would be too much.
constexpr std::uint32_t kMaxThreads = 256;

/// As many threads are a group of several waves.
constexpr std::uint32_t kManyThreads = 128;

/// The largest wave that is asked for, as a ballot of more is more than a word; and what most devices have.
constexpr std::uint32_t kWave = 32;

/// Fewest strands of a work group that leave the fewest threads of its waves idle.
std::uint32_t strandsThatFill(std::uint32_t threadsOfStrand) {
    std::uint32_t best = 1;
    double bestShare = 0.0;
    for (std::uint32_t strands = 1; strands <= kBlockLanes; strands *= 2) {
        const std::uint32_t threads = strands * threadsOfStrand;
        if (strands > 1 && threads > kManyThreads) break;
        const double share = static_cast<double>(threads) / ((threads + kWave - 1) / kWave * kWave);
        if (share > bestShare + 0.05) {
            best = strands;
            bestShare = share;
        }
    }
    return best;
}

/// The largest that holds whole strands and of which a group is made; 0: none does.
std::uint32_t waveFor(std::uint32_t threadsOfStrand, std::uint32_t threadsOfGroup,
                      const gpu::WaveSizes& waves) {
    for (std::uint32_t wave = kWave; wave >= threadsOfStrand; wave /= 2) {
        if (waves.has(wave) && wave % threadsOfStrand == 0 && threadsOfGroup % wave == 0) return wave;
    }
    return 0;
}

BatchShape shapeFor(std::uint32_t points, bool exact, StrandStorage storage, const LayoutOptions& options,
                    bool few, const gpu::WaveSizes& waves) {
    BatchShape shape;
    shape.points = points;
    shape.exact = exact;
    shape.storage = storage;
    if (shape.storage == StrandStorage::lanes && points < kMinInLanes) shape.storage = StrandStorage::threads;
    if (shape.storage == StrandStorage::groups && points > kMaxInGroups)
        shape.storage = StrandStorage::threads;
    if (points > kMaxInThreads) shape.storage = StrandStorage::buffers;
    shape.unrolled = options.unroll && exact && points <= kMaxUnrolled;
    if (!sharesBlocks(shape.storage)) return shape;
    shape.together = true;
    shape.strands = 1;
    if (shape.storage == StrandStorage::wisps) return shape;
    const bool pairs = points % 2 == 0 && points >= kMinInPairs;
    shape.perThread = pairs ? options.perThread.value_or(few ? 1 : 2) : 1;
    const std::uint32_t threads = points / shape.perThread;
    // Of many strands groups of several waves are faster, as those do not wait for each other.
    const bool several = options.waves && !few && waveFor(threads, kManyThreads, waves) != 0;
    const std::uint32_t chosen =
        several ? std::min(kManyThreads / threads, kBlockLanes) : strandsThatFill(threads);
    shape.strands =
        std::min(options.groupStrands.value_or(chosen), std::max(std::bit_floor(kMaxThreads / threads), 1u));
    if (options.waves) shape.wave = waveFor(threads, threads * shape.strands, waves);
    return shape;
}

}  // namespace

LayoutOptions layoutFor(gpu::DeviceType type) {
    // A driver that compiles for a CPU takes seconds for unrolled loops and gains nothing by them, and its
    // work groups are loops themselves.
    if (type == gpu::DeviceType::Cpu)
        return {.storage = StrandStorage::threads, .unroll = false, .members = 1};
    return {};
}

std::vector<StrandBatch> makeBatches(const runtime::RestShape& shape, const LayoutOptions& options,
                                     const gpu::WaveSizes& waves) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> blocksOf;
    for (std::uint32_t b = 0; b < shape.blocks.size(); ++b) blocksOf[shape.blocks[b].points].push_back(b);
    const bool exact = blocksOf.size() <= kMaxExact;
    if (!exact) {
        std::map<std::uint32_t, std::vector<std::uint32_t>> shared;
        for (const auto& [points, blocks] : blocksOf) {
            auto& all = shared[std::max(std::bit_ceil(points), kMinShared)];
            all.insert(all.end(), blocks.begin(), blocks.end());
        }
        blocksOf = std::move(shared);
    }
    const bool few = shape.blocks.size() <= kMaxBlocksInLanes;
    const StrandStorage storage =
        options.storage.value_or(few ? StrandStorage::lanes : StrandStorage::threads);
    std::vector<StrandBatch> batches;
    for (auto& [points, blocks] : blocksOf) {
        StrandBatch batch;
        batch.shape =
            shapeFor(points, exact, storage, options, shape.blocks.size() <= kMaxBlocksOfOne, waves);
        batch.shape.members =
            options.members.value_or(shape.blocks.size() <= kMaxBlocksOfMembers ? kMembers : 1);
        batch.slots = static_cast<std::uint32_t>(blocks.size()) * kBlockLanes;
        batch.blocks = std::move(blocks);
        batches.push_back(std::move(batch));
    }
    return batches;
}

gpu::BufferPtr ModelBuffers::at(std::uint32_t slot) const {
    const auto found = std::ranges::find(read, slot, &ModelBuffer::slot);
    return found == read.end() ? nullptr : found->buffer;
}

Result<bool> haveFloats(gpu::Device& device, gpu::BufferPtr& buffer, const char* name, std::size_t count,
                        std::uint32_t elementBytes) {
    if (buffer == nullptr ? count == 0 : buffer->desc().size == count * sizeof(float)) return false;
    buffer = nullptr;
    if (count == 0) return false;
    const std::vector<float> content(count);
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = count * sizeof(float);
    desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
    desc.elementBytes = elementBytes;
    auto made = device.createBuffer(desc, std::as_bytes(std::span(content)));
    if (!made) return tl::unexpected(made.error());
    buffer = std::move(*made);
    return true;
}

Status makeRestBuffers(gpu::Device& device, const runtime::RestShape& shape, StrandBatch& batch) {
    const runtime::RestSlots rest = runtime::restOfSlots(shape, batch.inSlots());
    Status status;
    const auto make = [&]<class T>(gpu::BufferPtr& buffer, const char* name,
                                   const runtime::Vector<T>& content) {
        if (!status) return;
        auto made = makeBuffer<T>(device, name, gpu::Usage::ShaderRead, content.size(), content);
        if (made) {
            buffer = std::move(*made);
        } else {
            status = tl::unexpected(made.error());
        }
    };
    make(batch.rest, "rest shape", rest.rest);
    make(batch.segments, "segments", rest.segments);
    make(batch.blockCounts, "blocks of strands", rest.blocks);
    make(batch.firstPoints, "first points", rest.firstPoints);
    return status;
}

}  // namespace hairloom::gpu_simulation
