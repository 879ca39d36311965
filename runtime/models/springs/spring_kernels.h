// SPDX-License-Identifier: MIT
#pragma once
// The stages of springs, compiled once for each instruction set.

#include <cstddef>
#include <span>

#include "models/springs/spring_block.h"

namespace hairloom::runtime {

struct SpringKernels {
    Stage stages[kStageCount];              ///< by StageId; null for those of other models
    std::size_t solverFloats[kStageCount];  ///< of LaneFrame::solver that a stage needs for a point
    /// Stages that follow each other, in one pass and with the same bits: damping or none, by 0 and 1, then
    /// the air's stage, by Air, then gravity or none, then `verlet`.
    Stage moves[2][kAirCount][2];
    /// The stages of such a pass one by one, with the same bits: between them `previous` holds the way of the
    /// substep. First what opens it, then what follows another one, by StageId; null for other stages.
    Stage partsOfMove[2][kStageCount];
    /// As `moves`: `angularStraight` or `angular`, then `length`, where tension is kept.
    Stage bendAndProject[2];
    /// As `moves`: `continuousCollision`, then `collision` or `collisionBack`.
    Stage bothCollisions[2];
    /// Multiplies every displacement by `factor`: the speed stays when the length of the substep changes.
    void (*rescale)(const SpringBlock& block, float factor);
    /// Halves the ways that position Verlet has found: from rest the first step is x₁ = x₀ + ½ a h², and the
    /// velocity that it keeps is that of the half step.
    Stage startHalfway;
    /// Fills windRoot and windTip for the context's wind and substeps, for the frame that begins at the
    /// phases `from` and ends at `to`.
    void (*sampleWind)(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context,
                       const float* from, const float* to);
};
/// Those for the best instruction set of this machine.
const SpringKernels& springKernels();

/// As few passes over the block as there are kernels for.
Passes passesOf(std::span<const StageId> stages, const SpringKernels& kernels);
/// A call for each stage, with the same bits.
Passes singlePassesOf(std::span<const StageId> stages, const SpringKernels& kernels);

}  // namespace hairloom::runtime
