// SPDX-License-Identifier: MIT
// A frame of strands in one dispatch: a thread, or several of a group, take their strand through all substeps. What
// is done in a substep is HAIR_STAGES, the list that the engine's plan makes (runtime/plan.h); the other macros that
// make a permutation follow from it. Whoever compiles this defines
//   HAIR_POINTS      points that a strand may have; HAIR_EXACT 1: all have as many
//   HAIR_UNROLL      1: loops along the strand are unrolled
//   HAIR_STORAGE     0 … 4: see storage.hlsli; HAIR_STRANDS: of a work group
//   HAIR_TOGETHER, HAIR_PER_THREAD, HAIR_WAVE: see storage.hlsli, lanes.hlsli
//   HAIR_CLAMPED     1, 2: clamped points
//   HAIR_EVALUATION  0; 1: integrators that evaluate forces elsewhere; 2: RK4; 3: backward Euler with coil springs
//   HAIR_BEND        0; 1: with stiffness; 2: with the factors of the strand's matrix
//   HAIR_TARGETS     1: rest directions; HAIR_TENSIONS 1: kept from substep to substep
//   HAIR_SPHERES     0; 1: in a constant buffer; 2: in a buffer
//   HAIR_WIND, HAIR_SLEEP, HAIR_VELOCITIES
#define HAIR_MEMBERS 1
#include "simulation_types.h"
#include "math.hlsli"
#include "storage.hlsli"
#include "roots.hlsli"
#include "air.hlsli"
#include "integrate.hlsli"
#include "springs.hlsli"
#include "bend.hlsli"
#include "implicit.hlsli"
#include "length.hlsli"
#include "collide.hlsli"
#include "sleeping.hlsli"

void runSubsteps() {
#if HAIR_WIND
    sampleWind();
#endif
    [loop] for (gSubstep = 0; gSubstep < gFrame.substeps; ++gSubstep) {
        HAIR_STAGES
    }
}

#if HAIR_STORAGE >= 3
#include "shared_block.hlsli"
#endif
#if HAIR_STORAGE == 3
#include "frame_lanes.hlsli"
#elif HAIR_STORAGE == 4
#include "frame_wisps.hlsli"
#else
#include "frame_threads.hlsli"
#endif
