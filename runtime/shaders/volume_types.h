// SPDX-License-Identifier: MIT
// What the kernels of hair against hair share with the program.
#ifndef HAIRLOOM_VOLUME_TYPES_H
#define HAIRLOOM_VOLUME_TYPES_H
#include "types.h"

#ifdef __cplusplus
#include <cstddef>
namespace hairloom::shaders {
#endif

/// Of a batch of strands; the first seven are of the whole volume.
struct VolumeConstants {
    float cellSize;  ///< metres, before it is doubled until the nodes suffice
    float maxNodes;
    float targetDensity;
    float repulsion;  ///< m²/s²
    float share;      ///< of the velocity around it that hair takes on: 1 − exp(−friction dt)
    float dt;         ///< seconds of the frame
    float h;          ///< seconds of a substep, in which the state's displacements are
    uint slots;
    uint points;  ///< that a strand of the batch may have
    uint clampedPoints;
    uint sleeps;    ///< not 0: strands that are pushed wake up
    uint together;  ///< not 0: the points of a strand stand side by side
    uint rods;      ///< not 0: strands keep velocities, as rods do
    uint unused1, unused2, unused3;
};

#ifdef __cplusplus
static_assert(sizeof(VolumeConstants) == 64 && offsetof(VolumeConstants, slots) == 28);
}  // namespace hairloom::shaders
#endif
#endif
