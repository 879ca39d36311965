// SPDX-License-Identifier: MIT
#pragma once
// The seam between the engine and its inner loops. A kernel is a stage over one block: kBlockLanes strands of
// equal point count, stored so that neighbouring lanes are neighbouring strands (index = point · kBlockLanes
// + lane). The block keeps this shape for every instruction set, and kernels use only exactly rounded
// operations without fused multiply-add, so the results have the same bits on each of them.
//
// Positions are relative to the strand's own root, which keeps single precision where hair needs it;
// `previous` is the position one substep ago relative to the root of now, so position − previous is the world
// displacement.

#include <cstdint>
#include <span>

#include "runtime/plan.h"
#include "runtime/wind.h"

namespace hairloom::runtime {

inline constexpr std::uint32_t kBlockLanes = 32;

/// x, y and z of one quantity, each an array.
struct Planes {
    float* x = nullptr;
    float* y = nullptr;
    float* z = nullptr;
};

struct ConstPlanes {
    const float* x = nullptr;
    const float* y = nullptr;
    const float* z = nullptr;
};

struct BlockView {
    std::uint32_t points;     ///< per strand
    std::uint32_t firstFree;  ///< points before it are clamped
    Planes position;
    Planes previous;
    ConstPlanes rest;            ///< vector of segment s, from point s to s + 1, in the root's frame, at
                                 ///< [s · kBlockLanes + lane]; metres
    const float* length;         ///< of each segment, likewise
    const float* inverseLength;  ///< 0 for a segment without length
    // Of the angular springs, null while they are off; at segments like `rest`.
    const float*
        pull;  ///< share of its offset from its rest place that a segment's end goes back in a substep
    const float* damp;  ///< share of the change of that offset that it goes back
    Planes offset;      ///< from the segment's end to its rest place, after the last substep
};

/// What the strands of a block go through in one frame; lives on the stack of the thread that runs the block.
struct alignas(64) LaneFrame {
    float root[3][kBlockLanes];          ///< at the start of the frame, world
    float rootStep[3][kBlockLanes];      ///< the root's way in one substep
    float rotationFrom[4][kBlockLanes];  ///< x, y, z, w
    float rotationTo[4][kBlockLanes];
    float rotation[4][kBlockLanes];  ///< of now; kept by the stage `roots`
    float windRoot[2][3]
                  [kBlockLanes];  ///< the air's way in one substep at start and end of the frame, at the root
    float windTip[2][3][kBlockLanes];
};

struct MovingSphere {
    Float3 from_ws;  ///< centre at the start of the frame
    Float3 step;     ///< the centre's way in one substep
    float radius;
};

/// What all blocks share in one substep.
struct SubstepContext {
    std::uint32_t index = 0;  ///< substep of the frame, from 0
    std::uint32_t count = 1;
    float h = 0.0f;              ///< seconds
    float velocityShare = 1.0f;  ///< exp(−h/τ)
    Float3 gravityStep;          ///< g·h²
    float dragShare = 0.0f;      ///< 1 − exp(−airDrag·h)
    std::uint32_t lengthIterations = 0;
    float maximalExtension = 0.0f;
    float pearlRoot = 0.0f;
    float pearlTip = 0.0f;
    float friction = 0.0f;
    float restitution = 0.0f;
    float penaltyStep = 0.0f;  ///< (ω·h)² of the penalty spring
    std::span<const MovingSphere> spheres;
};

using Stage = void (*)(const BlockView& block, LaneFrame& lanes, const SubstepContext& context);

struct Kernels {
    Stage stages[kStageCount];  ///< by StageId
    /// Multiplies every displacement by `factor`: the speed stays when the length of the substep changes.
    void (*rescale)(const BlockView& block, float factor);
    /// Fills windRoot and windTip, for substeps of h seconds, for the frame that begins at the phases `from`
    /// and ends at `to`.
    void (*sampleWind)(const BlockView& block, LaneFrame& lanes, float h, const Wind& wind, const float* from,
                       const float* to);
    const char* target;  ///< name of the instruction set
};

/// The kernels for the best instruction set of this machine.
const Kernels& kernels();

}  // namespace hairloom::runtime
