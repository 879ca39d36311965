// SPDX-License-Identifier: MIT
// A frame of strands in one dispatch: a thread takes its strand through all substeps. What it does in a substep
// is HAIR_STAGES, the list that the engine's plan makes (runtime/plan.h); the other macros that make a
// permutation follow from it. Whoever compiles this defines
//   HAIR_POINTS      points that a strand may have; HAIR_EXACT 1: all have as many
//   HAIR_UNROLL      1: loops along the strand are unrolled
//   HAIR_STORAGE     0, 1, 2: see storage.hlsli
//   HAIR_CLAMPED     1, 2: clamped points
//   HAIR_EVALUATION  0; 1: integrators that evaluate forces elsewhere; 2: RK4
//   HAIR_BEND        0; 1: with stiffness; 2: with the factors of the strand's matrix
//   HAIR_TARGETS     1: rest directions; HAIR_CURVES 1: kept from substep to substep
//   HAIR_SPHERES     0; 1: in a constant buffer; 2: in a buffer
//   HAIR_WIND, HAIR_SLEEP, HAIR_VELOCITIES
#include "shaders/simulation/simulation_types.h"
#include "shaders/simulation/math.hlsli"
#include "shaders/simulation/storage.hlsli"
#include "shaders/simulation/roots.hlsli"
#include "shaders/simulation/air.hlsli"
#include "shaders/simulation/integrate.hlsli"
#include "shaders/simulation/springs.hlsli"
#include "shaders/simulation/bend.hlsli"
#include "shaders/simulation/length.hlsli"
#include "shaders/simulation/collide.hlsli"

groupshared uint gGroupMoved;
groupshared uint gGroupFastest;
groupshared uint gGroupRestored;
groupshared uint gGroupNear;

bool rootMoved() {
    return any(gRootsTo[2 * gSlot].xyz != float3(rootRow(0), rootRow(1), rootRow(2))) ||
           any(gRootsTo[2 * gSlot + 1] != float4(rootRow(3), rootRow(4), rootRow(5), rootRow(6)));
}

#if HAIR_SLEEP
StructuredBuffer<float4> gWaking : register(t8);  // centre and reach of spheres that have changed

/// Whether a sphere that has changed since the last frame comes within reach of the strand.
bool sphereNear() {
    const float3 root = float3(rootRow(0), rootRow(1), rootRow(2));
    bool near = false;
    [loop] for (uint i = 0; i < gFrame.wakingCount; ++i) {
        const float3 gap = root - gWaking[i].xyz;
        near = near || dot(gap, gap) < gWaking[i].w * gWaking[i].w;
    }
    return near;
}
#endif

void loadState() {
#if HAIR_STORAGE != 2
    EACH for (uint p = 0; p < POINTS; ++p) {
        setPosition(p, savedPosition(p));
        setPrevious(p, savedPrevious(p));
#if HAIR_CURVES
        setCurve(p, savedCurve(p));
#endif
    }
#endif
#if HAIR_CURVES
    gTank = gTanks[gSlot];
    gMotion = gTanks[gFrame.slots + gSlot];
#endif
}

void saveState() {
#if HAIR_STORAGE != 2
    EACH for (uint p = 0; p < POINTS; ++p) {
        savePosition(p, position(p));
        savePrevious(p, previous(p));
#if HAIR_CURVES
        saveCurve(p, curve(p));
#endif
    }
#endif
#if HAIR_CURVES
    gTanks[gSlot] = gTank;
    gTanks[gFrame.slots + gSlot] = gMotion;
#endif
}

/// Puts the strand to its rest place on the root of the end of the frame, without speed.
void placeAtRest() {
    float3 at = float3(0, 0, 0);
    EACH for (uint p = 0; p < POINTS; ++p) {
        setPosition(p, at);
        setPrevious(p, at);
        at += rotate(gRotationTo, restVector(p));
#if HAIR_CURVES
        setCurve(p, float3(0, 0, 0));
#endif
    }
#if HAIR_CURVES
    gTank = HAIRLOOM_NO_CURVE;
    gMotion = 0.0;
#endif
}

/// Greatest squared displacement of a free point in the last substep; `sound` is false where a point is no
/// number or has left the range in which its square is one.
float fastest(out bool sound) {
    float most = 0.0;
    sound = true;
    EACH for (uint p = 0; p < POINTS; ++p) {
        const float3 here = position(p);
        const float3 moved = here - previous(p);
        const float squared = dot(moved, moved);
        sound = sound && isSound(here) && isSound(moved) && dot(here, here) < 1e12 && squared < 1e12;
        if (p >= FIRST_FREE) most = max(most, squared);
    }
    return most;
}

void writePlaces() {
    const uint first = gFirstPoints[gSlot];
    if (first == 0xffffffffu) return;
    const float3 root = gRootsTo[2 * gSlot].xyz;
    EACH for (uint p = 0; p < POINTS; ++p) {
        gPlaces[first + p] = float4(root + position(p), 1.0);
#if HAIR_VELOCITIES
        gVelocities[first + p] = float4((position(p) - previous(p)) * (1.0 / gFrame.h), 0.0);
#endif
    }
}

void runSubsteps() {
#if HAIR_WIND
    sampleWind();
#endif
    [loop] for (gSubstep = 0; gSubstep < gFrame.substeps; ++gSubstep) {
        HAIR_STAGES
    }
}

/// Takes stock after the last substep; the group's greatest displacement in gGroupFastest.
void finishStrand(uint block, uint lane) {
    bool sound;
    float most = fastest(sound);
#if HAIR_CURVES
    gMotion = most * (1.0 / (gFrame.h * gFrame.h));
#endif
    if (!sound) {
        placeAtRest();
        most = 0.0;
        if (lane < gBlocks[block].y) InterlockedAdd(gReport[REPORT_RESTORED], 1u);
        InterlockedOr(gGroupRestored, 1u);
    }
    InterlockedMax(gGroupFastest, asuint(most));
}

[numthreads(HAIRLOOM_GROUP_STRANDS, 1, 1)]
void main(uint3 group : SV_GroupID, uint lane : SV_GroupIndex) {
    const uint block = group.x;
    gSlot = block * HAIRLOOM_GROUP_STRANDS + lane;
#if HAIR_STORAGE == 1
    gLane = lane;
#endif
#if !HAIR_EXACT
    gPointCount = gBlocks[block].x;
#endif
    if (lane == 0) gGroupMoved = gGroupFastest = gGroupRestored = gGroupNear = 0u;
    GroupMemoryBarrierWithGroupSync();
    if (rootMoved()) InterlockedOr(gGroupMoved, 1u);
    bool runs = true;
#if HAIR_SLEEP
    // Read by all before the last barrier, written by one after it.
    float rested = gRests[2 * block];
    bool asleep = gRests[2 * block + 1] != 0.0;
    if (asleep && sphereNear()) InterlockedOr(gGroupNear, 1u);
    GroupMemoryBarrierWithGroupSync();
    if (asleep && (gGroupMoved != 0u || gGroupNear != 0u || gFrame.wakeAll != 0u)) {
        asleep = false;
        rested = 0.0;
    }
    runs = !asleep;
#endif
    if (runs) {
        loadState();
        enterFrame();
        if (gFrame.rescale != 1.0) rescaleMotion();
        runSubsteps();
        finishStrand(block, lane);
    }
    GroupMemoryBarrierWithGroupSync();
#if HAIR_SLEEP
    if (runs) {
        const bool slow = gGroupMoved == 0u && gGroupRestored == 0u && asfloat(gGroupFastest) < gFrame.slowSquared;
        rested = slow ? rested + gFrame.dt : 0.0;
        asleep = slow && rested >= gFrame.sleepDelay;
        if (asleep) {
            EACH for (uint p = 0; p < POINTS; ++p) setPrevious(p, position(p));
        }
    } else {
        rested += gFrame.dt;
    }
    if (lane == 0) {
        gRests[2 * block] = rested;
        gRests[2 * block + 1] = asleep ? 1.0 : 0.0;
        if (asleep) InterlockedAdd(gReport[REPORT_ASLEEP], gBlocks[block].y);
    }
#endif
    if (runs) {
        saveState();
        leaveFrame();
        writePlaces();
        if (lane == 0 && gGroupRestored == 0u) InterlockedMax(gReport[REPORT_FASTEST], gGroupFastest);
    }
}
