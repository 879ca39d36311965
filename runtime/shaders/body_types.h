// SPDX-License-Identifier: MIT
// What kernels are told of a body (hairloom/body_field.h). Metres, world space.
#ifndef HAIRLOOM_BODY_TYPES_H
#define HAIRLOOM_BODY_TYPES_H
#include "types.h"

#ifdef __cplusplus
#include <cstddef>
namespace hairloom::shaders {
#endif

/// BodyField's constants of blocks.
#define HAIRLOOM_BODY_BLOCK_CELLS 4
#define HAIRLOOM_BODY_BLOCK_QUADS 80
#define HAIRLOOM_BODY_NO_BLOCK 0xffff
#define HAIRLOOM_BODY_FINE_UNIT 1e-4
#define HAIRLOOM_BODY_FINE_REACH 0.006
#define HAIRLOOM_BODY_FINE_END 0.010
/// Shares of a distance and of a cell that are sure (engine/body_free.h).
#define HAIRLOOM_BODY_SURE 0.9
#define HAIRLOOM_BODY_UNSURE 0.2
#define HAIRLOOM_BODY_UNSURE_FINE 0.05
/// Rows of the buffer of poses for each pose, and for each bone in a step.
#define HAIRLOOM_BODY_POSE_ROWS 3
#define HAIRLOOM_BODY_BONE_ROWS 7
/// Planes of a point: what rods keep of a body from substep to substep (kFoldPlanes), and in one.
#define HAIRLOOM_ROD_FOLD_PLANES 8
#define HAIRLOOM_ROD_BODY_PLANES 22

struct BodyConstants {
    float4 low;    ///< the table's first corner at rest; w: metres of a cell
    uint4 size;    ///< cells along x, y, z; w: bones, 1 where all move alike
    float unit;    ///< metres of one step of a coarse distance
    uint palette;  ///< poses of a step; 1 where all bones move alike
    uint steps;    ///< of the frame; poses are of its start and of each step's end
    uint moves;    ///< not 0: the body moves in the frame
    /// Where BodyTable's arrays begin in the table; cells are first.
    uint quads, pairs, refinements, finer;
    uint skins, skinBones, skinWeights, boxes;
    uint bonesAt;   ///< first row of bones in the buffer of poses
    uint hasBoxes;  ///< not 0: bones move nothing outside theirs
    uint unused0, unused1;
};

#ifdef __cplusplus
static_assert(sizeof(BodyConstants) == 96);
}  // namespace hairloom::shaders
#endif
#endif
