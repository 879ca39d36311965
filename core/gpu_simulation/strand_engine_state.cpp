// SPDX-License-Identifier: GPL-3.0-or-later
// The state on its way between the device and the form of the engine on the CPU.
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/gpu_simulation/strand_engine_impl.h"
#include "runtime/checks.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;
using runtime::kBlockLanes;
using runtime::RootFrame;

/// Rows of one value per slot in the order of blocks: `rows` of them a block.
void rowsToBlocks(const StrandBatch& batch, std::span<const float> values, std::size_t rows, float* blocks) {
    for (std::size_t n = 0; n < batch.blocks.size(); ++n) {
        for (std::size_t r = 0; r < rows; ++r) {
            std::copy_n(values.data() + r * batch.slots + n * kBlockLanes, kBlockLanes,
                        blocks + (batch.blocks[n] * rows + r) * kBlockLanes);
        }
    }
}

std::vector<float> rowsOfBatch(const StrandBatch& batch, const float* blocks, std::size_t rows) {
    std::vector<float> values(rows * batch.slots);
    for (std::size_t n = 0; n < batch.blocks.size(); ++n) {
        for (std::size_t r = 0; r < rows; ++r) {
            std::copy_n(blocks + (batch.blocks[n] * rows + r) * kBlockLanes, kBlockLanes,
                        values.data() + r * batch.slots + n * kBlockLanes);
        }
    }
    return values;
}

}  // namespace

Status StrandEngine::Impl::readBatch(const StrandBatch& batch, runtime::State& state) const {
    std::vector<float> values;
    if (auto status = read(batch.state, values); !status) return status;
    planesOfBlocks(*shape, batch, values, state.planes, runtime::kStatePlanes);
    if (auto status = read(batch.roots, values); !status) return status;
    rowsToBlocks(batch, values, runtime::kRootRows, state.roots.data());
    if (batch.curves != nullptr) {
        if (auto status = read(batch.curves, values); !status) return status;
        planesOfBlocks(*shape, batch, values, state.curves, 3);
        if (auto status = read(batch.tanks, values); !status) return status;
        const std::span<const float> all = values;
        rowsToBlocks(batch, all.first(batch.slots), 1, state.tanks.data());
        rowsToBlocks(batch, all.subspan(batch.slots), 1, state.motions.data());
    }
    if (batch.rests == nullptr) return {};
    if (auto status = read(batch.rests, values); !status) return status;
    for (std::size_t n = 0; n < batch.blocks.size(); ++n)
        state.rests[batch.blocks[n]] = {values[2 * n], values[2 * n + 1] != 0.0f};
    return {};
}

Result<runtime::State> StrandEngine::readState() {
    const Impl& impl = *impl_;
    const runtime::RestShape& shape = *impl.shape;
    runtime::State state;
    state.planes.assign(shape.planeFloats * runtime::kStatePlanes, 0.0f);
    state.roots.assign(shape.blocks.size() * runtime::kRootRows * kBlockLanes, 0.0f);
    state.rests.resize(shape.blocks.size());
    if (std::ranges::any_of(impl.batches, [](const StrandBatch& batch) { return batch.curves != nullptr; })) {
        state.curves.assign(shape.planeFloats * 3, 0.0f);
        state.tanks.assign(shape.blocks.size() * kBlockLanes, runtime::kNoCurve);
        state.motions.assign(shape.blocks.size() * kBlockLanes, 0.0f);
    }
    for (const StrandBatch& batch : impl.batches) {
        if (auto status = impl.readBatch(batch, state); !status) return tl::unexpected(status.error());
    }
    state.spheres = impl.spheresBefore;
    state.rootsMin_ws = impl.rootsMin_ws;
    state.rootsMax_ws = impl.rootsMax_ws;
    state.substep = impl.substep;
    return state;
}

Status StrandEngine::Impl::writeBatch(gpu::CommandList& list, const StrandBatch& batch,
                                      const runtime::State& state) const {
    const auto send = [&](const gpu::BufferPtr& buffer, const std::vector<float>& values) {
        list.updateBuffer(buffer, 0, std::as_bytes(std::span(values)));
    };
    send(batch.state, planesOfBatch(*shape, batch, state.planes, runtime::kStatePlanes));
    send(batch.roots, rowsOfBatch(batch, state.roots.data(), runtime::kRootRows));
    if (batch.curves != nullptr) {
        std::vector<float> tanks(std::size_t{batch.slots} * 2, 0.0f);
        std::fill_n(tanks.begin(), batch.slots, runtime::kNoCurve);
        if (!state.curves.empty()) {
            send(batch.curves, planesOfBatch(*shape, batch, state.curves, 3));
            const std::vector<float> kept = rowsOfBatch(batch, state.tanks.data(), 1);
            const std::vector<float> motions = rowsOfBatch(batch, state.motions.data(), 1);
            std::ranges::copy(kept, tanks.begin());
            std::ranges::copy(motions, tanks.begin() + batch.slots);
        }
        send(batch.tanks, tanks);
    }
    if (batch.rests != nullptr) {
        std::vector<float> rests;
        for (const std::uint32_t block : batch.blocks) {
            rests.push_back(state.rests[block].time);
            rests.push_back(state.rests[block].asleep ? 1.0f : 0.0f);
        }
        send(batch.rests, rests);
    }
    return {};
}

Status StrandEngine::Impl::writeState(const runtime::State& state) {
    auto list = device.createCommandList();
    if (!list) return tl::unexpected(list.error());
    for (const StrandBatch& batch : batches) {
        if (auto status = writeBatch(**list, batch, state); !status) return status;
    }
    std::vector<Float3> positions(shape->offsets.back());
    runtime::readPositions(*shape, state, positions);
    std::vector<shaders::float4> quads;
    quads.reserve(positions.size());
    for (const Float3& p : positions) quads.push_back({p.x, p.y, p.z, 1.0f});
    (*list)->updateBuffer(places, 0, std::as_bytes(std::span(quads)));
    for (std::size_t b = 0; b < shape->blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < shape->blocks[b].strands; ++lane) {
            const auto row = [&](std::size_t r) {
                return state.roots[(b * runtime::kRootRows + r) * kBlockLanes + lane];
            };
            roots[shape->blocks[b].strandOfLane[lane]] = {{row(0), row(1), row(2)},
                                                          {row(3), row(4), row(5), row(6)}};
        }
    }
    uploadRoots(**list);
    auto submission = device.submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    spheresBefore = state.spheres;
    substep = state.substep;
    runtime::Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const RootFrame& root : roots) {
        const Float3 p = root.position;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    rootsMin_ws = low;
    rootsMax_ws = high;
    return (*submission)->wait();
}

Status StrandEngine::writeState(const runtime::State& state) {
    return impl_->writeState(state);
}

Status StrandEngine::reset(std::span<const RootFrame> roots_ws) {
    assert(roots_ws.size() == strandCount());
    const runtime::RestShape& shape = *impl_->shape;
    runtime::State state;
    state.planes.assign(shape.planeFloats * runtime::kStatePlanes, 0.0f);
    state.roots.assign(shape.blocks.size() * runtime::kRootRows * kBlockLanes, 0.0f);
    state.rests.resize(shape.blocks.size());
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::uint32_t strand = shape.blocks[b].strandOfLane[lane];
            RootFrame root = roots_ws[strand];
            if (!runtime::usableWithin(root, runtime::kFarthest)) root = shape.restRoots[strand];
            const std::array<float, runtime::kRootRows> values{
                root.position.x, root.position.y, root.position.z, root.rotation.x,
                root.rotation.y, root.rotation.z, root.rotation.w};
            for (std::size_t r = 0; r < values.size(); ++r)
                state.roots[(b * runtime::kRootRows + r) * kBlockLanes + lane] = values[r];
            runtime::placeAtRest(shape, state, b, lane);
        }
    }
    return impl_->writeState(state);
}

Result<FrameReport> StrandEngine::report() {
    FrameReport report;
    std::vector<std::uint32_t> words;
    if (auto status = impl_->read(impl_->reportBuffer, words); !status) return tl::unexpected(status.error());
    if (impl_->substep > 0.0f) report.fastest = std::sqrt(std::bit_cast<float>(words[0])) / impl_->substep;
    report.restoredStrands = words[1];
    report.asleep = words[2];
    if (impl_->underWay.empty()) return report;
    const auto times = impl_->underWay.back()->passTimes();
    if (!times) return tl::unexpected(times.error());
    for (const gpu::PassTime& time : *times) report.milliseconds += time.milliseconds;
    return report;
}

Result<runtime::Measurements> StrandEngine::measure() {
    const auto state = readState();
    if (!state) return tl::unexpected(state.error());
    return runtime::measureState(*impl_->shape, *state, settings());
}

Status StrandEngine::readPositions(std::span<Float3> positions_ws) {
    assert(positions_ws.size() == pointCount());
    std::vector<shaders::float4> quads;
    if (auto status = impl_->read(impl_->places, quads); !status) return status;
    for (std::size_t p = 0; p < quads.size(); ++p) positions_ws[p] = {quads[p].x, quads[p].y, quads[p].z};
    return {};
}

Status StrandEngine::readVelocities(std::span<Float3> velocities_ws) {
    const auto state = readState();
    if (!state) return tl::unexpected(state.error());
    runtime::readVelocities(*impl_->shape, *state, velocities_ws);
    return {};
}

Result<std::uint64_t> StrandEngine::stateHash() {
    const auto state = readState();
    if (!state) return tl::unexpected(state.error());
    return state->hash();
}

}  // namespace hairloom::gpu_simulation
