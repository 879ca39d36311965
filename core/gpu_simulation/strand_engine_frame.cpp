// SPDX-License-Identifier: GPL-3.0-or-later
// One frame: what it brings, what is sent to the device, what runs there.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/base/parallel.h"
#include "core/gpu_simulation/compiled_kernel.h"
#include "core/gpu_simulation/strand_engine_impl.h"
#include "runtime/engine/checks.h"
#include "runtime/shaders/live_types.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Binding;
using runtime::Effect;
using runtime::Float3;
using runtime::RootFrame;

constexpr std::size_t kBlocksPerJob = 8;

}  // namespace

/// Takes the roots that the frame ends on; whether some have moved.
bool StrandEngine::Impl::takeRoots(const runtime::FrameInput& input) {
    assert(input.roots_ws.size() == placed.roots.size());
    runtime::takeFrameRoots(input.roots_ws, runtime::teleportDistanceOf(wanted, input), !rootsOfDevice,
                            placed);
    rootsOfDevice = false;
    return std::ranges::find(placed.moved, true) != placed.moved.end();
}

/// The same of roots that are on the device; whether they have moved.
bool StrandEngine::Impl::takeRoots(const DeviceRoots& given) {
    placed.rejected = 0;
    placed.motion = std::min(given.motion, wanted.teleportDistance);
    placed.min_ws = given.min_ws;
    placed.max_ws = given.max_ws;
    const bool moved = given.moved || !rootsOfDevice;
    rootsOfDevice = true;
    return moved;
}

/// Puts the positions of the frame's roots in the order of the slots.
Status StrandEngine::Impl::gatherRoots(gpu::CommandList& list, const DeviceRoots& given) {
    if (rootRows == nullptr) {
        auto made = compiledKernel(device, "root_rows");
        if (!made) return tl::unexpected(made.error());
        rootRows = std::move(*made);
    }
    gpu::PassDesc pass;
    pass.name = "roots of slots";
    for (StrandBatch& batch : batches) {
        if (batch.strandOfSlot != nullptr) continue;
        std::vector<std::uint32_t> strands;
        for (std::size_t slot = 0; slot < batch.slots; ++slot) {
            const runtime::Block& block = shape->blocks[batch.blocks[slot / runtime::kBlockLanes]];
            strands.push_back(block.strandOfLane[slot % runtime::kBlockLanes]);
        }
        auto made = makeBuffer<std::uint32_t>(device, "strands of slots", gpu::Usage::ShaderRead,
                                              strands.size(), strands);
        if (!made) return tl::unexpected(made.error());
        batch.strandOfSlot = std::move(*made);
    }
    list.beginPass(pass);
    list.setPipeline(rootRows);
    for (const StrandBatch& batch : batches) {
        const shaders::RootRowConstants constants{batch.slots, given.moved ? 1.0f : 0.0f, 0, 0};
        list.setConstants(0, gpu::bytesOf(constants));
        const std::array<Binding, 3> bound{Binding::read(0, given.frames_ws),
                                           Binding::read(1, batch.strandOfSlot),
                                           Binding::write(0, batch.rootsTo)};
        list.bind(bound);
        list.dispatch((batch.slots + HAIRLOOM_LIVE_GROUP - 1) / HAIRLOOM_LIVE_GROUP);
    }
    list.endPass();
    return {};
}

/// Measures what is known of the last frame from the origin of this one. What sleeps wakes, to write its
/// positions anew.
void StrandEngine::Impl::moveOrigin(std::array<double, 3> next_ws) {
    if (!runtime::isFinite(next_ws)) next_ws = origin_ws.value_or(std::array<double, 3>{});
    originShift = runtime::shiftOfOrigin(origin_ws.value_or(next_ws), next_ws);
    origin_ws = next_ws;
    if (originShift == Float3{}) return;
    for (RootFrame& root : placed.roots) root.position = root.position + originShift;
    if (body) body->moveOrigin(originShift);
    for (runtime::Sphere& sphere : spheresBefore) sphere.center_ws = sphere.center_ws + originShift;
    placed.min_ws = placed.min_ws + originShift;
    placed.max_ws = placed.max_ws + originShift;
    restsVoid = wakeAll = rootsMoved = true;
}

/// `moved` may be empty: none has.
void StrandEngine::Impl::uploadRoots(gpu::CommandList& list, const runtime::Vector<bool>& moved) const {
    for (const StrandBatch& batch : batches) {
        const runtime::Slots slots = batch.inSlots();
        runtime::Vector<shaders::float4> rows(std::size_t{slots.count} * 2);
        runtime::putRootsOfSlots(*shape, slots, placed.roots, moved, rows);
        list.updateBuffer(batch.rootsTo, 0, bytesOfVector(rows));
    }
}

/// Where kernels read them from buffers.
void StrandEngine::Impl::uploadSpheres(gpu::CommandList& list) {
    const auto upload = [&]<class T>(gpu::BufferPtr& buffer, const char* name,
                                     const runtime::Vector<T>& content) {
        const std::size_t count = std::max<std::size_t>(content.size(), 1);
        if (buffer == nullptr || buffer->desc().size < count * sizeof(T)) {
            const std::vector<T> nothing(2 * count);
            auto made = makeBuffer<T>(device, name, gpu::Usage::ShaderRead, nothing.size(), nothing);
            // An engine without the buffer names it when it binds it.
            buffer = made ? std::move(*made) : nullptr;
        }
        if (buffer != nullptr && !content.empty()) list.updateBuffer(buffer, 0, bytesOfVector(content));
    };
    bool sleeps = false, many = false;
    for (const StrandBatch& batch : batches) {
        sleeps = sleeps || batch.key.sleep;
        many = many || batch.key.spheres == SphereSource::buffer;
    }
    if (many) {
        runtime::Vector<shaders::SphereConstants> all;
        runtime::putSphereConstants(pressingSpheres(), movingCapsules, all);
        upload(spheres, "spheres", all);
    }
    if (!sleeps) return;
    runtime::Vector<shaders::float4> reaches;
    runtime::putWaking(frameSpheres, reaches);
    upload(waking, "waking spheres", reaches);
}

/// What other settings and plans do to the state: nothing sleeps.
void StrandEngine::Impl::uploadChanges(gpu::CommandList& list) {
    if (!restsVoid) return;
    for (const StrandBatch& batch : batches) {
        if (batch.rests == nullptr) continue;
        const std::vector<float> awake(batch.blocks.size() * HAIRLOOM_REST_NUMBERS, 0.0f);
        list.updateBuffer(batch.rests, 0, bytesOfVector(awake));
    }
    restsVoid = false;
}

shaders::SimulationConstants StrandEngine::Impl::constants(const runtime::SubstepContext& context,
                                                           const runtime::FrameInput& input,
                                                           const StrandBatch& batch) const {
    const runtime::GpuFrame frame{run.settings, run.wind.wind, pressingSpheres(), frameSpheres.waking.size(),
                                  substep,      wakeAll,       *origin_ws,        originShift};
    auto c = runtime::frameConstants(frame, context, input, batch.inSlots(), batch.key.shape.strands);
    if (batch.key.spheres == SphereSource::constants)
        c.sphereCount = std::min<std::uint32_t>(c.sphereCount, HAIRLOOM_CONSTANT_SPHERES);
    return c;
}

void StrandEngine::Impl::dispatch(gpu::CommandList& list, const StrandBatch& batch,
                                  const shaders::SimulationConstants& constants,
                                  const runtime::SubstepContext& context) const {
    list.setPipeline(batch.kernel);
    std::vector<Binding> bindings;
    const auto read = [&](std::uint32_t slot, const gpu::BufferPtr& buffer) {
        if (buffer != nullptr) bindings.push_back(Binding::read(slot, buffer));
    };
    const auto write = [&](std::uint32_t slot, const gpu::BufferPtr& buffer) {
        if (buffer != nullptr) bindings.push_back(Binding::write(slot, buffer));
    };
    read(0, batch.rest);
    read(1, batch.segments);
    read(4, batch.blockCounts);
    read(5, batch.firstPoints);
    read(6, batch.rootsTo);
    read(7, spheres);
    read(8, waking);
    for (const ModelBuffer& own : batch.model.read) read(own.slot, own.buffer);
    write(0, batch.state);
    write(1, batch.roots);
    write(2, batch.rests);
    write(3, reportBuffer);
    write(4, positions);
    write(batch.model.state.slot, batch.model.state.buffer);
    write(7, batch.scratch);
    if (batch.key.body) {
        body->bind(bindings);
        read(12, batch.clearances);
    }
    const GpuModel& ofModel = gpuModelOf(batch.key.model);
    write(ofModel.gatheredSlot, batch.gathered);
    write(ofModel.velocitySlot(batch.key), velocities);
    list.bind(bindings);
    list.setConstants(0, gpu::bytesOf(constants));
    model->setConstants(list, context, run.wind.wind, substep, batch);
    if (batch.key.body) body->setConstants(list);
    if (batch.key.spheres == SphereSource::constants) {
        runtime::Vector<shaders::SphereConstants> all;
        runtime::putSphereConstants(pressingSpheres(), movingCapsules, all);
        all.resize(HAIRLOOM_CONSTANT_SPHERES);
        list.setConstants(1, bytesOfVector(all));
    }
    const std::uint32_t groups = constants.groups;
    list.dispatch(std::min<std::uint32_t>(groups, HAIRLOOM_GROUP_ROW),
                  (groups + HAIRLOOM_GROUP_ROW - 1) / HAIRLOOM_GROUP_ROW);
}

Status StrandEngine::Impl::record(gpu::CommandList& list, const runtime::FrameInput& input,
                                  const DeviceRoots* deviceRoots, bool continues) {
    if (!(input.dt > 0.0f) || !std::isfinite(input.dt)) return {};
    known.reset();
    moveOrigin(input.origin_ws);
    if (continues) {
        forgetLastPiece(list);
    } else {
        constexpr std::array<std::uint32_t, kReportWords> kNothing{};
        list.updateBuffer(reportBuffer, 0, std::as_bytes(std::span(kNothing)));
    }
    if (input.inner.empty() || deviceRoots != nullptr) return recordStraight(list, input, deviceRoots);
    pieces.take(input, runtime::substepsIn(wanted, input.dt));
    for (std::size_t i = 0; i < pieces.count(); ++i) {
        const auto poseBefore =
            body ? std::span<const runtime::BonePose>(body->pose()) : std::span<const runtime::BonePose>();
        if (i > 0) {
            originShift = {};
            forgetLastPiece(list);
        }
        const runtime::FrameInput part = pieces.at(i, {placed.roots, spheresBefore, poseBefore});
        if (auto recorded = recordStraight(list, part, nullptr); !recorded) return recorded;
    }
    return {};
}

/// Strands are asleep and fast at the end of a frame; what was restored and guarded counts all through it.
void StrandEngine::Impl::forgetLastPiece(gpu::CommandList& list) {
    constexpr std::array<std::uint32_t, 1> kNone{};
    for (const std::uint64_t word : {kReportFastest, kReportAsleep})
        list.updateBuffer(reportBuffer, 4 * word, std::as_bytes(std::span(kNone)));
}

/// Poses the body where the frame needs it; how many substeps it takes beside the body, as many as usual
/// without one.
std::uint32_t StrandEngine::Impl::takeBody(const runtime::FrameInput& input, std::uint32_t usual) {
    bodyMoves = false;
    if (!followsBody()) {
        if (body) body->setPose({});
        return usual;
    }
    // Hair is as fast as its roots were, and slows in a tenth of a second. How fast it is the device knows.
    // What is cut keeps its speed from before.
    constexpr float kSlowing = 10.0f;  // 1/s
    const bool cut = input.cut || !(placed.motion < wanted.teleportDistance);
    fastRoots = std::max(cut ? 0.0f : placed.motion / input.dt, fastRoots * std::exp(-kSlowing * input.dt));
    const std::uint32_t substeps = runtime::substepsBesideBody(fastRoots * input.dt, usual);
    bodyMoves = body->takeFrame(input, runtime::teleportDistanceOf(wanted, input), substeps);
    wakeAll = wakeAll || bodyMoves;
    if (body->hasPose() && skinSpheres.size() == frameSpheres.given) frameSpheres.ofSkin = skinSpheres;
    return substeps;
}

Status StrandEngine::Impl::recordStraight(gpu::CommandList& list, const runtime::FrameInput& input,
                                          const DeviceRoots* deviceRoots) {
    const Float3 lowBefore = placed.min_ws, highBefore = placed.max_ws;
    const bool found = deviceRoots != nullptr;
    const bool moves = found ? takeRoots(*deviceRoots) : takeRoots(input);
    const runtime::Vector<runtime::Capsule> capsulesBefore = frameSpheres.capsules;
    runtime::takeSpheres(wanted, shape->longestStrand, {spheresBefore, capsulesBefore, input.cut},
                         input.spheres, input.capsules, frameSpheres);
    const bool skin = followsBody();
    std::uint32_t substeps = takeBody(input, runtime::substepsIn(wanted, input.dt));
    const Float3 low{std::min(placed.min_ws.x, lowBefore.x), std::min(placed.min_ws.y, lowBefore.y),
                     std::min(placed.min_ws.z, lowBefore.z)};
    const Float3 high{std::max(placed.max_ws.x, highBefore.x), std::max(placed.max_ws.y, highBefore.y),
                      std::max(placed.max_ws.z, highBefore.z)};
    takePoseAmounts(input.poseAmounts);
    if (auto chosen = choose(input, low, high); !chosen) return chosen;
    movingSpheres.clear();
    movingCapsules.clear();
    pressing = 0;
    // While kernels of other settings are made; a body is posed for those that are wanted.
    if (!skin) substeps = runtime::substepsIn(run.settings, input.dt);
    if (run.plan.on(Effect::collision)) {
        if (runtime::modelOf(run.settings.strandModel).listsSpheres) {
            pressing = moveCapsules(frameSpheres, substeps, movingSpheres, movingCapsules);
        } else {
            moveSpheres(frameSpheres, substeps, movingSpheres);
            pressing = movingSpheres.size();
        }
    }
    runtime::SubstepContext context = runtime::substepContext(run.settings, run.plan, input.dt, substeps,
                                                              pressingSpheres(), movingCapsules);
    if (meetsBody(run.settings)) {
        context.spheresRest = context.spheresRest && !bodyMoves;
        context.collisionRadiusAtRoot = run.settings.collisionRadiusRoot;
        context.collisionRadiusAtTip = run.settings.collisionRadiusTip;
    }

    // Roots that rest are there already, once the device knows that they do.
    if (substep == 0.0f || moves || rootsMoved) {
        if (!found) uploadRoots(list, placed.moved);
        if (auto gathered = found ? gatherRoots(list, *deviceRoots) : Status(); !gathered) return gathered;
    }
    rootsMoved = moves;
    uploadChanges(list);
    uploadSpheres(list);
    if (skin && body->hasPose()) {
        if (auto sent = body->upload(list); !sent) return sent;
    }
    model->upload(list, *shape, run.plan, run.settings, context.h, batches);
    gpu::PassDesc pass;
    pass.name = "strands";
    list.beginPass(pass);
    for (const StrandBatch& batch : batches) dispatch(list, batch, constants(context, input, batch), context);
    list.endPass();
    if (volume) volume->record(list, batches, run.settings.clampedPoints, input.dt, context.h);
    const auto given = std::span(frameSpheres.usable).first(frameSpheres.given);
    spheresBefore.assign(given.begin(), given.end());
    substep = context.h;
    wakeAll = false;
    model->closeFrame();
    return {};
}

}  // namespace hairloom::gpu_simulation
