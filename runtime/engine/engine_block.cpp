// SPDX-License-Identifier: MIT
// What one block of strands goes through in a frame, on whatever thread.
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/checks.h"
#include "engine/engine_impl.h"

namespace hairloom::runtime {
namespace {

/// Whether no point is farther than `reach` metres from its anchor. Else all anchors are moved to their
/// points: points that slip slowly would leave theirs one after the other.
bool stays(const BlockView& blockView, float reach, Rest& rest) {
    decltype(rest.anchors) now;
    bool all = true;
    for (std::uint32_t a = 0; a < Rest::kAnchors; ++a) {
        const std::uint32_t point = (blockView.points - 1) * (a + 1) / Rest::kAnchors;
        const float* const before = rest.anchors.data() + std::size_t{a} * 3 * kBlockLanes;
        float* const at = now.data() + std::size_t{a} * 3 * kBlockLanes;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::size_t i = std::size_t{point} * kBlockLanes + lane;
            at[lane] = blockView.position.x[i];
            at[kBlockLanes + lane] = blockView.position.y()[i];
            at[2 * kBlockLanes + lane] = blockView.position.z()[i];
            const Float3 away{at[lane] - before[lane], at[kBlockLanes + lane] - before[kBlockLanes + lane],
                              at[2 * kBlockLanes + lane] - before[2 * kBlockLanes + lane]};
            all = all && dot(away, away) < reach * reach;
        }
    }
    if (!all) rest.anchors = now;
    return all;
}

}  // namespace

void Engine::Impl::runBlock(std::size_t block, LaneFrame& lanes, const Frame& frame) {
    BlockReport& report = blockReports_[block];
    if (host_.nanoseconds) report.nanoseconds.fill(0);
    report.restored = report.guarded = 0;
    report.fastest = 0.0f;
    strands_->prepareBlock(*shape_, settings_, frame, block);
    if (state_.rests[block].asleep) {
        state_.rests[block].time += frame.input->dt;
        return;
    }
    BlockRoom room;
    BlockView& blockView = view(block, room);
    lanes.guarded = 0;
    lanes.touchable.clear();
    lanes.touchableCapsules.clear();
    enterFrame(block, blockView, lanes, frame);
    strands_->enterBlock(*shape_, settings_, frame, block, blockView, lanes);
    runStages(block, blockView, lanes, frame);
    const std::uint32_t strands = shape_->blocks[block].strands;
    const std::uint32_t own =
        strands < kBlockLanes ? (1u << strands) - 1 : ~0u;  // lanes past the last repeat it
    report.guarded = static_cast<std::uint32_t>(std::popcount(lanes.guarded & own));
    report.fastest = frame.kernels->fastest(blockView);
    if (!std::isfinite(report.fastest)) restoreStrands(block, blockView);
    rest(block, blockView, frame);
}

/// Puts lanes that are no longer sound back to rest.
void Engine::Impl::restoreStrands(std::size_t block, const BlockView& blockView) {
    BlockReport& report = blockReports_[block];
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        bool sound = true;
        for (std::uint32_t p = 0; p < blockView.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const auto at = [&](const Planes& planes) {
                return Float3{planes.x[i], planes.y()[i], planes.z()[i]};
            };
            const Float3 position = at(blockView.position), moved = position - at(blockView.previous);
            // As Kernels::fastest has it: comparisons with what is no number are false.
            sound = sound && dot(position, position) < kFarthest * kFarthest &&
                    dot(moved, moved) < kFarthest * kFarthest;
        }
        if (sound) continue;
        placeAtRest(block, lane);
        if (lane < shape_->blocks[block].strands) ++report.restored;
    }
    report.fastest = 0.0f;
}

/// Counts how long the block has been at rest, and puts it to sleep. At rest is what is slow, and what
/// trembles in its place, as hair does that lies on an edge of the skin: in five delays it goes no farther
/// than slow hair may in one. That takes longer, since hair that swings turns round in its place, too.
void Engine::Impl::rest(std::size_t block, const BlockView& blockView, const Frame& frame) {
    constexpr float kLonger = static_cast<float>(HAIRLOOM_STAY_DELAYS);
    Rest& rest = state_.rests[block];
    const BlockReport& report = blockReports_[block];
    if (report.rootsMoved || report.restored > 0) {
        rest.time = rest.stayed = 0.0f;
        return;
    }
    const float slow = settings_.sleepSpeed * frame.context.h, delay = settings_.sleepDelay;
    rest.time = report.fastest < slow * slow ? rest.time + frame.input->dt : 0.0f;
    const bool wakes = bodyMoves_ || isWindy();  // each frame anew
    const bool stayed = !wakes && stays(blockView, settings_.sleepSpeed * delay, rest);
    rest.stayed = stayed ? rest.stayed + frame.input->dt : 0.0f;
    const bool isSlow = rest.time > 0.0f && rest.time >= delay, trembles = rest.stayed > kLonger * delay;
    rest.asleep = isSlow || trembles;
    if (!rest.asleep) return;
    if (!isSlow) rest.time = rest.stayed;
    const std::size_t floats = std::size_t{blockView.points} * kBlockLanes;
    std::copy_n(blockView.position.x, floats, blockView.previous.x);
    std::copy_n(blockView.position.y(), floats, blockView.previous.y());
    std::copy_n(blockView.position.z(), floats, blockView.previous.z());
}

/// A cut turns the strand along rigidly: positions and velocities.
void Engine::Impl::turnAlong(const BlockView& view, std::uint32_t lane, Quat turn) const {
    for (std::uint32_t p = 0; p < view.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        for (const Planes& planes : {view.position, view.previous}) {
            const Float3 turned = rotate(turn, Float3{planes.x[i], planes.y()[i], planes.z()[i]});
            planes.x[i] = turned.x;
            planes.y()[i] = turned.y;
            planes.z()[i] = turned.z;
        }
        strands_->turnAlong(view, i, turn);
    }
}

/// Lanes whose roots go farther in the frame than teleportDistance, or are cut, start where they end.
void Engine::Impl::teleportLanes(const BlockView& view, float* rows, const float* next) const {
    const float cut = teleportDistance_ * std::abs(teleportDistance_);
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const auto position = [&](const float* from) {
            return Float3{from[lane], from[kBlockLanes + lane], from[2 * kBlockLanes + lane]};
        };
        const auto rotation = [&](const float* from) {
            const float* const at = from + 3 * kBlockLanes + lane;
            return Quat{at[0], at[kBlockLanes], at[2 * kBlockLanes], at[3 * kBlockLanes]};
        };
        const Float3 displacement = position(next) - position(rows);
        if (dot(displacement, displacement) <= cut) continue;
        turnAlong(view, lane, rotation(next) * conjugate(rotation(rows)));
        for (std::size_t r = 0; r < kRootRows; ++r)
            rows[r * kBlockLanes + lane] = next[r * kBlockLanes + lane];
    }
}

/// Fills the lanes' displacement through the frame and keeps its end for the next.
void Engine::Impl::enterFrame(std::size_t block, const BlockView& view, LaneFrame& lanes,
                              const Frame& frame) {
    float* const rows = state_.roots.data() + block * kRootRows * kBlockLanes;
    const float* const next = nextRoots_.data() + block * kRootRows * kBlockLanes;
    const auto at = [](const float* from, std::size_t r, std::uint32_t lane) {
        return from[r * kBlockLanes + lane];
    };
    if (blockReports_[block].rootsTeleported) teleportLanes(view, rows, next);
    const float share = 1.0f / static_cast<float>(frame.context.count);
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            lanes.root[r][lane] = at(rows, r, lane);
            lanes.rootDisplacement[r][lane] = (at(next, r, lane) - at(rows, r, lane)) * share;
        }
    }
    std::copy_n(rows + 3 * kBlockLanes, 4 * kBlockLanes, lanes.rotationFrom[0]);
    std::copy_n(next + 3 * kBlockLanes, 4 * kBlockLanes, lanes.rotationTo[0]);
    std::copy_n(next, kRootRows * kBlockLanes, rows);
}

void Engine::Impl::openSubstep(SubstepContext& context, const Frame& frame) {
    context.windPhases = frame.windPhases[context.index].data();
    if (context.index > 0) context.stepRatio = 1.0f;
}

/// Pass `i` of a substep.
void Engine::Impl::runPass(std::size_t i, const BlockView& view, LaneFrame& lanes,
                           const SubstepContext& context, const Frame& frame) {
    const Passes& passes = frame.passes;
    passes.calls[i](view, lanes, context);
    if (frame.starts && context.index == 0 && passes.afterStart && i + 1 == passes.startCalls)
        passes.afterStart(view, lanes, context);
}

void Engine::Impl::runStages(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame) {
    SubstepContext context = frame.context;
    if (!host_.nanoseconds) {
        for (context.index = 0; context.index < context.count; ++context.index) {
            openSubstep(context, frame);
            for (std::size_t i = 0; i < frame.passes.count; ++i) runPass(i, view, lanes, context, frame);
        }
        return;
    }
    auto& times = blockReports_[block].nanoseconds;
    std::uint64_t before = host_.nanoseconds();
    for (context.index = 0; context.index < context.count; ++context.index) {
        openSubstep(context, frame);
        for (std::size_t i = 0; i < frame.passes.count; ++i) {
            runPass(i, view, lanes, context, frame);
            const std::uint64_t after = host_.nanoseconds();
            times[static_cast<std::size_t>(plan_.stages()[i])] += after - before;
            before = after;
        }
    }
}

void listTouchable(const RestShape& shape, const SimulationSettings& settings, const SubstepContext& context,
                   std::size_t block, LaneFrame& lanes) {
    const float hair = hairReach(settings, shape.longestStrand);
    const auto substeps = static_cast<float>(context.count);
    const auto reaches = [&](const MovingSphere& sphere) {
        const Float3 middle = sphere.from_ws + sphere.step * (0.5f * substeps);
        const float reach = hair + sphere.radius + 0.5f * substeps * sphere.stepLength;
        for (std::uint32_t lane = 0; lane < shape.blocks[block].strands; ++lane) {
            const Float3 root{lanes.root[0][lane], lanes.root[1][lane], lanes.root[2][lane]};
            const Float3 displacement{lanes.rootDisplacement[0][lane], lanes.rootDisplacement[1][lane],
                                      lanes.rootDisplacement[2][lane]};
            if (length(root + displacement * (0.5f * substeps) - middle) <=
                reach + 0.5f * substeps * length(displacement))
                return true;
        }
        return false;
    };
    for (const MovingSphere& sphere : context.spheres) {
        if (reaches(sphere)) lanes.touchable.push_back(sphere);
    }
    for (const MovingCapsule& capsule : context.capsules) {
        if (reaches(capsule.around)) lanes.touchableCapsules.push_back(capsule);
    }
}

}  // namespace hairloom::runtime
