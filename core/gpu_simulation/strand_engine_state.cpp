// SPDX-License-Identifier: GPL-3.0-or-later
// The state on its way between the device and the form of the engine on the CPU.
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>

#include "core/gpu_simulation/strand_engine_impl.h"
#include "runtime/engine/checks.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;
using runtime::kBlockLanes;
using runtime::RootFrame;

/// Of a batch, in the order in which takeBatch() takes them.
std::vector<gpu::BufferPtr> changingBuffers(const StrandBatch& batch) {
    std::vector<gpu::BufferPtr> buffers;
    for (const auto& buffer : {batch.state, batch.roots, batch.model.state.buffer, batch.rests}) {
        if (buffer != nullptr) buffers.push_back(buffer);
    }
    return buffers;
}

}  // namespace

/// All in one submission, one after the other.
Result<std::vector<std::byte>> StrandEngine::Impl::readTogether(
    const std::vector<gpu::BufferPtr>& buffers) const {
    std::uint64_t size = 0;
    for (const gpu::BufferPtr& buffer : buffers) size += buffer->desc().size;
    if (readBack == nullptr || readBack->desc().size < size) {
        gpu::BufferDesc desc;
        desc.name = "read back";
        desc.size = size;
        desc.usage = gpu::Usage::None;
        desc.memory = gpu::MemoryKind::ReadBack;
        auto made = device.createBuffer(desc);
        if (!made) return tl::unexpected(made.error());
        readBack = std::move(*made);
    }
    auto list = device.createCommandList();
    if (!list) return tl::unexpected(list.error());
    std::uint64_t at = 0;
    for (const gpu::BufferPtr& buffer : buffers) {
        (*list)->copyBuffer(buffer, 0, readBack, at, buffer->desc().size);
        at += buffer->desc().size;
    }
    const auto submission = device.submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    if (auto status = (*submission)->wait(); !status) return tl::unexpected(status.error());
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (auto status = device.readMapped(readBack, 0, bytes); !status) return tl::unexpected(status.error());
    return bytes;
}

/// Takes the state of a batch from the front of what was read.
void StrandEngine::Impl::takeBatch(const StrandBatch& batch, std::span<const std::byte>& bytes,
                                   runtime::State& state) const {
    const auto take = [&](const gpu::BufferPtr& buffer) {
        std::vector<float> values(static_cast<std::size_t>(buffer->desc().size / sizeof(float)));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
        bytes = bytes.subspan(values.size() * sizeof(float));
        return values;
    };
    const std::vector<float> moving = take(batch.state);
    runtime::planesOfBlocks(*shape, batch.inSlots(), moving, state.planes, runtime::kStatePlanes);
    runtime::rowsToBlocks(batch.inSlots(), take(batch.roots), runtime::kRootRows, state.roots.data());
    const std::vector<float> own =
        batch.model.state.buffer != nullptr ? take(batch.model.state.buffer) : std::vector<float>();
    model->readOwn(*shape, batch, moving, own, state);
    if (batch.rests == nullptr) return;
    runtime::restsToBlocks(batch.inSlots(), take(batch.rests), state.rests);
    for (const std::uint32_t b : batch.blocks) {
        if (!state.rests[b].asleep) continue;
        // What sleeps has no speed; kernels of lanes take it away when they wake it.
        const runtime::Block& block = shape->blocks[b];
        float* const planes = state.planes.data() + block.firstPlane * runtime::kStatePlanes;
        std::copy_n(planes, 3 * planeSize(block), planes + 3 * planeSize(block));
    }
}

Result<runtime::State> StrandEngine::readState() {
    return impl_->readState();
}

/// With the arrays that the model and the plan have, all 0.
runtime::State StrandEngine::Impl::emptyState() const {
    runtime::State state;
    state.planes.assign(shape->planeFloats * runtime::kStatePlanes, 0.0f);
    state.roots.assign(shape->blocks.size() * runtime::kRootRows * kBlockLanes, 0.0f);
    state.rests.resize(shape->blocks.size());
    state.model = run.settings.strandModel;
    model->allocateState(*shape, run.plan, state);
    return state;
}

Result<runtime::State> StrandEngine::Impl::readState() {
    if (known) return *known;
    runtime::State state = emptyState();
    std::vector<gpu::BufferPtr> buffers;
    for (const StrandBatch& batch : batches) {
        const auto own = changingBuffers(batch);
        buffers.insert(buffers.end(), own.begin(), own.end());
    }
    const auto bytes = readTogether(buffers);
    if (!bytes) return tl::unexpected(bytes.error());
    std::span<const std::byte> rest = *bytes;
    for (const StrandBatch& batch : batches) takeBatch(batch, rest, state);
    state.spheres = spheresBefore;
    state.capsules = frameSpheres.capsules;
    state.rootsMin_ws = placed.min_ws;
    state.rootsMax_ws = placed.max_ws;
    state.substep = substep;
    state.origin_ws = origin_ws;
    if (body) state.body = body->pose();
    state.fastest = fastRoots;
    known = state;
    return state;
}

Status StrandEngine::Impl::writeBatch(gpu::CommandList& list, const StrandBatch& batch,
                                      const runtime::State& state) const {
    const auto send = [&](const gpu::BufferPtr& buffer, std::span<const float> values) {
        list.updateBuffer(buffer, 0, std::as_bytes(values));
    };
    auto moving = runtime::planesOfSlots(*shape, batch.inSlots(), state.planes, runtime::kStatePlanes);
    runtime::Vector<float> own;
    model->writeOwn(*shape, batch, state, moving, own);
    moving.resize(std::size_t{batch.shape.points} * batch.slots * kDevicePlanes, 0.0f);
    send(batch.state, moving);
    send(batch.roots, runtime::rowsOfSlots(batch.inSlots(), state.roots.data(), runtime::kRootRows));
    if (!own.empty()) send(batch.model.state.buffer, own);
    if (batch.rests != nullptr) send(batch.rests, runtime::restsOfSlots(batch.inSlots(), state.rests));
    return {};
}

Status StrandEngine::Impl::writeState(const runtime::State& given) {
    known.reset();
    const std::optional<runtime::State> made = model->takeState(*shape, given);
    const runtime::State& state = made ? *made : given;
    auto list = device.createCommandList();
    if (!list) return tl::unexpected(list.error());
    for (const StrandBatch& batch : batches) {
        if (auto status = writeBatch(**list, batch, state); !status) return status;
    }
    std::vector<Float3> points_ws(shape->offsets.back());
    runtime::readPositions(*shape, state, points_ws);
    std::vector<shaders::float4> quads;
    quads.reserve(points_ws.size());
    for (const Float3& p : points_ws) quads.push_back({p.x, p.y, p.z, 1.0f});
    (*list)->updateBuffer(positions, 0, std::as_bytes(std::span(quads)));
    for (std::size_t b = 0; b < shape->blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < shape->blocks[b].strands; ++lane) {
            const auto row = [&](std::size_t r) {
                return state.roots[(b * runtime::kRootRows + r) * kBlockLanes + lane];
            };
            placed.roots[shape->blocks[b].strandOfLane[lane]] = {{row(0), row(1), row(2)},
                                                                 {row(3), row(4), row(5), row(6)}};
        }
    }
    uploadRoots(**list, {});
    rootsMoved = rootsOfDevice = false;
    auto submission = device.submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    spheresBefore = state.spheres;
    frameSpheres.capsules = state.capsules;
    substep = state.substep;
    origin_ws = state.origin_ws;
    if (body) body->setPose(state.body);
    fastRoots = state.fastest;
    runtime::Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const RootFrame& root : placed.roots) {
        const Float3 p = root.position;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    placed.min_ws = low;
    placed.max_ws = high;
    return (*submission)->wait();
}

Status StrandEngine::writeState(const runtime::State& state) {
    return impl_->writeState(state);
}

Status StrandEngine::reset(std::span<const RootFrame> roots_ws) {
    assert(roots_ws.size() == strandCount());
    const runtime::RestShape& shape = *impl_->shape;
    runtime::State state = impl_->emptyState();
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
            impl_->model->placeAtRest(shape, state, b, lane);
        }
    }
    return impl_->writeState(state);
}

FrameReport StrandEngine::reportFrom(std::span<const std::uint32_t, kReportWords> words, float substep) {
    FrameReport report;
    if (substep > 0.0f) report.fastest = std::sqrt(std::bit_cast<float>(words[kReportFastest])) / substep;
    report.restoredStrands = words[1];
    report.asleep = words[kReportAsleep];
    report.guardedStrands = words[3];
    return report;
}

Result<FrameReport> StrandEngine::report() {
    const auto bytes = impl_->readTogether({impl_->reportBuffer});
    if (!bytes) return tl::unexpected(bytes.error());
    std::array<std::uint32_t, kReportWords> words{};
    std::memcpy(words.data(), bytes->data(), sizeof(words));
    FrameReport report = reportFrom(words, impl_->substep);
    report.kernelMilliseconds = impl_->kernelMilliseconds;
    report.rejectedRoots = impl_->placed.rejected;
    report.rejectedSpheres = impl_->frameSpheres.rejected;
    report.rejectedWinds = impl_->rejectedWinds;
    const auto milliseconds = wait();
    if (!milliseconds) return tl::unexpected(milliseconds.error());
    report.milliseconds = *milliseconds;
    return report;
}

Result<double> StrandEngine::wait() {
    while (!impl_->submissionsInFlight.empty()) {
        const auto times = impl_->submissionsInFlight.front()->passTimes();
        if (!times) return tl::unexpected(times.error());
        impl_->submissionsInFlight.pop_front();
        impl_->milliseconds = 0.0;
        for (const gpu::PassTime& time : *times) impl_->milliseconds += time.milliseconds;
    }
    return impl_->milliseconds;
}

Result<runtime::Measurements> StrandEngine::measure() {
    const auto state = readState();
    if (!state) return tl::unexpected(state.error());
    return runtime::measureState(*impl_->shape, *state, settings(), impl_->frameSpheres.ofSkin);
}

Status StrandEngine::readPositions(std::span<Float3> positions_ws) {
    assert(positions_ws.size() == pointCount());
    const auto bytes = impl_->readTogether({impl_->positions});
    if (!bytes) return tl::unexpected(bytes.error());
    for (std::size_t p = 0; p < positions_ws.size(); ++p)
        std::memcpy(&positions_ws[p], bytes->data() + p * sizeof(shaders::float4), sizeof(Float3));
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
