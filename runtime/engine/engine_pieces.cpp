// SPDX-License-Identifier: MIT
// A frame of an engine, where there are poses inside: one frame after another, each without.

#include <algorithm>
#include <cmath>

#include "engine/engine_impl.h"

namespace hairloom::runtime {
namespace {

/// What a part of a frame reports, to that of the parts before it.
void addPiece(const StepReport& piece, StepReport& whole) {
    for (std::size_t i = 0; i < kStageCount; ++i) whole.stageMilliseconds[i] += piece.stageMilliseconds[i];
    whole.milliseconds += piece.milliseconds;
    whole.rejectedRoots = std::max(whole.rejectedRoots, piece.rejectedRoots);
    whole.rejectedSpheres = std::max(whole.rejectedSpheres, piece.rejectedSpheres);
    whole.rejectedWinds = std::max(whole.rejectedWinds, piece.rejectedWinds);
    whole.restoredStrands += piece.restoredStrands;
    whole.guardedStrands += piece.guardedStrands;
    whole.substeps += piece.substeps;
}

}  // namespace

/// Of the state, in the order of strands.
void Engine::Impl::readRoots(Vector<RootFrame>& roots_ws) const {
    roots_ws.resize(strandCount());
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        const float* const rows = state_.roots.data() + b * kRootRows * kBlockLanes;
        for (std::uint32_t lane = 0; lane < shape_->blocks[b].strands; ++lane) {
            const auto at = [&](std::size_t r) { return rows[r * kBlockLanes + lane]; };
            roots_ws[shape_->blocks[b].strandOfLane[lane]] = {{at(0), at(1), at(2)},
                                                              {at(3), at(4), at(5), at(6)}};
        }
    }
}

void Engine::Impl::step(const FrameInput& input) {
    if (!(input.dt > 0.0f) || !std::isfinite(input.dt)) return;
    const std::uint32_t substeps = substepsIn(settings_, input.dt);
    if (input.inner.empty()) return stepStraight(input, substeps);
    moveOrigin(input.origin_ws);
    pieces_.take(input, substeps);
    StepReport whole;
    for (std::size_t i = 0; i < pieces_.count(); ++i) {
        if (pieces_.startsWithin(i)) readRoots(rootsNow_);
        stepStraight(pieces_.at(i, {rootsNow_, state_.spheres, state_.body}), pieces_.substepsOf(i));
        addPiece(report_, whole);
    }
    report_ = whole;
}

}  // namespace hairloom::runtime
