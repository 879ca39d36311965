// SPDX-License-Identifier: MIT
#pragma once
// What the kernel of rods has of a block and is told of a substep (docs/engine.md, "Rods").

#include <cstddef>

#include "engine/kernels.h"
#include "shaders/rod_types.h"

namespace hairloom::runtime {

/// Of segment or vertex j at [j · kBlockLanes + lane]; a vertex stands at its outer segment, world space
/// unless said otherwise, all with the block's pitch. What an effect alone needs is null while it is off.
struct RodView {
    ConstPlanes tangent;          ///< of a segment in the shape without load, in the root's frame
    ConstPlanes axis;             ///< that a vertex twists about there
    ConstPlanes normal;           ///< long diameter of the section there; null of a round one
    const float* bend = nullptr;  ///< B/l̄ of a vertex, m³/s²
    const float* mass = nullptr;  ///< of each point, metres of hair
    const float* restRotation =
        nullptr;                ///< x, y, z, w of a segment: from the shape without load to the authored one
    float* rotation = nullptr;  ///< x, y, z, w: from the shape without load to the world
    ConstPlanes pose;           ///< where nodes are drawn to, in the root's frame; null without poses
    const float* poseRate = nullptr;  ///< how fast, 1/s
    ConstPlanes poseStrain;           ///< that vertices rest at
    Planes increment;                 ///< rotation of each segment in the last substep
    Planes displacement;              ///< of each point in the last substep, metres
    Planes velocity, velocityBefore;  ///< m/s, at the end of the last substep and of the one before
    Planes strain, strainBefore;      ///< likewise
    float* load = nullptr;  ///< force of each point's contacts in the last substep, m²/s²; negative: it slid
    /// Planes of the body that each point met last, where there is one, and before: kFoldPlanes.
    float* fold = nullptr;
    float* turn =
        nullptr;  ///< of each lane: most that a segment turned in the last substep, radians, or kRodNoStep
    float* energy = nullptr;  ///< of each lane, of motion, shape and weight, m³/s², or kRodNoEnergy
    bool curved = false;      ///< twist matters
};
/// There is no substep before that a second order scheme could build on.
inline constexpr float kRodNoStep = 1e9f;
/// Nothing is known of the energy before.
inline constexpr float kRodNoEnergy = 1e30f;

struct RodBlock : BlockView {
    RodView rod;
};

using shaders::RodNumbers;

/// The rods' stage, and the floats of LaneFrame::solver that it needs for a point.
struct RodKernel {
    Stage stage;
    std::size_t solverFloats;
};
RodKernel rodKernel();

}  // namespace hairloom::runtime
