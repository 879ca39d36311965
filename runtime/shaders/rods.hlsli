// SPDX-License-Identifier: MIT
// A frame of strands as elastic rods, HAIR_MEMBERS threads a strand and HAIR_STRANDS strands a work group, as rods.cpp of the
// engine has them. Whoever compiles this defines HAIR_RODS 1, both and, as strands.hlsli has them, HAIR_TOGETHER, HAIR_CLAMPED,
// HAIR_SPHERES, HAIR_WIND, HAIR_SLEEP, HAIR_VELOCITIES and HAIR_STAGES; HAIR_BODY 1 for rods that meet a body, which need HAIR_SPHERES,
// too (body.hlsli, which games do not get), and HAIR_POSES 1 where rods follow poses. Any number of points has the same kernel.
#define HAIR_POINTS gRod.points
#define HAIR_EXACT 0
#define HAIR_UNROLL 0
#define HAIR_STORAGE 2
#define HAIR_EVALUATION 0
#define HAIR_BEND 0
#define HAIR_TARGETS 0
#ifndef HAIR_POSES
#define HAIR_POSES 0
#endif
#include "simulation_types.h"
#include "rod_types.h"
#include "math.hlsli"
cbuffer Rods : register(b2) { RodConstants gRod; };
#include "storage.hlsli"
#include "rod_math.hlsli"
#include "rod_storage.hlsli"
#include "rod_placement.hlsli"
#include "roots.hlsli"
#if HAIR_WIND
/// At the end of the substep that has so many behind it.
float windPhase(uint m, uint left) { return mad(gRod.windTurns[m].x, float(left), gFrame.windWaves[m].w); }
#include "wind.hlsli"
#endif
#if HAIR_SPHERES
#include "rod_contact.hlsli"
#endif
#include "rod_members.hlsli"
#include "rod_substep.hlsli"
#include "sleeping.hlsli"

void runSubsteps() {
    const uint block = gSlot / HAIRLOOM_GROUP_STRANDS;
    gCurved = gCurvedBlocks[block] != 0u;
    gGuarded = false;
#if HAIR_SPHERES
    findReachableShapes();
#endif
    openMembers();
    [loop] for (gSubstep = 0; gSubstep < gFrame.substeps; ++gSubstep) {
        HAIR_STAGES
    }
    ALONE if (gGuarded && gSlot % HAIRLOOM_GROUP_STRANDS < gBlocks[block].y) InterlockedAdd(gReport[REPORT_GUARDED], 1u);
}

#if HAIR_MEMBERS > 1
#include "frame_members.hlsli"
#else
#include "frame_threads.hlsli"
#endif
