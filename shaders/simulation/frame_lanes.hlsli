// SPDX-License-Identifier: MIT
// A frame of strands whose points are lanes. Several work groups are a block of the engine, which falls asleep as one:
// each leaves what it has seen, and the last of them judges.

groupshared uint gStrandFastest[HAIR_STRANDS];
groupshared uint gStrandLost[HAIR_STRANDS];

/// Who the lane is.
void enterLane(uint group, uint lane) {
    gLane = lane;
    gStrand = lane / HAIR_POINTS;
    gPoint = lane % HAIR_POINTS;
    gFirst = lane - gPoint;
    gSide = 0;
    gSlot = group * HAIR_STRANDS + gStrand;
#if !HAIR_EXACT
    gPointCount = gBlocks[gSlot / HAIRLOOM_GROUP_STRANDS].x;
#endif
    gInner = gPoint > 0 ? lane - 1 : lane;
    gOuter = gPoint + 1 < HAIR_POINTS ? lane + 1 : lane;
}

/// What stays in the lane for the frame.
void loadState() {
    gPosition = savedPosition(gPoint);
    gPrevious = savedPrevious(gPoint);
    const float2 own = gSegments[slotOf(0, gPoint)];
    const float2 inner = gSegments[slotOf(0, gPoint > 0 ? gPoint - 1 : 0)];
    const float2 outer = gSegments[slotOf(0, min(gPoint + 1, uint(HAIR_POINTS) - 1))];
    gLength = own.x;
    gInverseLength = inverseOf(own.x);
    gInnerInverseLength = inverseOf(inner.x);
    gInverseMass = own.y;
    gOuterInverseMass = outer.y;
#if HAIR_BEND
    gStiff = stiffness(gPoint);
#endif
#if HAIR_BEND == 2
    [unroll] for (uint step = 0; step < BEND_STEPS; ++step) gReduction[step] = gFactors[slotOf(step, gPoint)];
    gReduced = gFactors[slotOf(BEND_STEPS, gPoint)].xy;
#endif
#if HAIR_TARGETS
    gTarget = target(gPoint);
#endif
#if HAIR_CURVES
    gCurve = savedCurve(gPoint);
    gTank = gTanks[gSlot];
    gMotion = gTanks[gFrame.slots + gSlot];
#endif
#if HAIR_TENSIONS
    gTension = savedTension(gPoint);
#endif
}

void saveState() {
    savePosition(gPoint, gPosition);
    savePrevious(gPoint, gPrevious);
#if HAIR_CURVES
    saveCurve(gPoint, gCurve);
    ONLY_POINT(0) {
        gTanks[gSlot] = gTank;
        gTanks[gFrame.slots + gSlot] = gMotion;
    }
#endif
#if HAIR_TENSIONS
    saveTension(gPoint, gTension);
#endif
}

/// See frame_threads.hlsli.
void placeAtRest() {
    float3 at = float3(0, 0, 0);
    [loop] for (uint p = 0; p < gPoint; ++p) at += rotate(gRootsTo[2 * gSlot + 1], restVector(p));
    gPosition = gPrevious = at;
#if HAIR_CURVES
    gCurve = float3(0, 0, 0);
    gTank = HAIRLOOM_NO_CURVE;
    gMotion = 0.0;
#endif
#if HAIR_TENSIONS
    gTension = 0.0;
#endif
}

/// Takes stock after the last substep.
void finishStrand(uint strands) {
    const float3 moved = gPosition - gPrevious;
    const float squared = dot(moved, moved);
    const bool sound =
        isSound(gPosition) && isSound(moved) && dot(gPosition, gPosition) < 1e12 && squared < 1e12;
    OWN_POINT {
        if (!sound) {
            InterlockedOr(gStrandLost[gStrand], 1u);
        } else if (gPoint >= FIRST_FREE) {
            InterlockedMax(gStrandFastest[gStrand], asuint(squared));
        }
    }
    GroupMemoryBarrierWithGroupSync();
    const bool lost = gStrandLost[gStrand] != 0u;
    const uint most = lost ? 0u : gStrandFastest[gStrand];
#if HAIR_CURVES
    gMotion = asfloat(most) * (1.0 / (gFrame.h * gFrame.h));
#endif
    if (lost) placeAtRest();
    ONLY_POINT(0) {
        if (lost) {
            if (gSlot % HAIRLOOM_GROUP_STRANDS < strands) InterlockedAdd(gReport[REPORT_RESTORED], 1u);
            InterlockedOr(gGroupRestored, 1u);
        }
        InterlockedMax(gGroupFastest, most);
    }
    GroupMemoryBarrierWithGroupSync();
}

void writePlace() {
    const uint first = gFirstPoints[gSlot];
    if (first == 0xffffffffu || gPoint >= POINTS) return;
    gPlaces[first + gPoint] = float4(gRootsTo[2 * gSlot].xyz + gPosition, 1.0);
#if HAIR_VELOCITIES
    gVelocities[first + gPoint] = float4((gPosition - gPrevious) * (1.0 / gFrame.h), 0.0);
#endif
}

#if HAIR_SLEEP
/// What the first thread of each work group of a block leaves, and what the last of them makes of it.
void judgeBlock(uint block, uint strands, float rested) {
    uint ignored, done, fastest, restored;
    InterlockedMax(gGathered[4 * block + 1], gGroupFastest, ignored);
    InterlockedOr(gGathered[4 * block + 2], gGroupRestored, ignored);
    DeviceMemoryBarrier();
    InterlockedAdd(gGathered[4 * block], 1u, done);
    if (done + 1 < HAIRLOOM_GROUP_STRANDS / HAIR_STRANDS) return;
    InterlockedExchange(gGathered[4 * block], 0u, ignored);
    InterlockedExchange(gGathered[4 * block + 1], 0u, fastest);
    InterlockedExchange(gGathered[4 * block + 2], 0u, restored);
    const bool slow = gGroupMoved == 0u && restored == 0u && asfloat(fastest) < gFrame.slowSquared;
    rested = slow ? rested + gFrame.dt : 0.0;
    const bool asleep = slow && rested >= gFrame.sleepDelay;
    gRests[2 * block] = rested;
    gRests[2 * block + 1] = asleep ? 1.0 : 0.0;
    if (asleep) InterlockedAdd(gReport[REPORT_ASLEEP], strands);
}
#endif

[numthreads(HAIR_THREADS, 1, 1)]
void main(uint3 place : SV_GroupID, uint lane : SV_GroupIndex) {
    const uint group = place.y * HAIRLOOM_GROUP_ROW + place.x;
    if (group >= gFrame.groups) return;
    enterLane(group, lane);
    const uint block = group * HAIR_STRANDS / HAIRLOOM_GROUP_STRANDS, strands = gBlocks[block].y;
    if (lane == 0) gGroupMoved = gGroupFastest = gGroupRestored = gGroupNear = 0u;
    ONLY_POINT(0) gStrandFastest[gStrand] = gStrandLost[gStrand] = 0u;
    GroupMemoryBarrierWithGroupSync();
    bool slept = false;
#if HAIR_SLEEP
    // The whole block's: each of its work groups comes to the same conclusion.
    float rested = gRests[2 * block];
    slept = gRests[2 * block + 1] != 0.0;
    [loop] for (uint s = lane; s < HAIRLOOM_GROUP_STRANDS; s += HAIR_THREADS) {
        const uint slot = block * HAIRLOOM_GROUP_STRANDS + s;
        if (rootMoves(slot)) InterlockedOr(gGroupMoved, 1u);
        if (slept && sphereNear(gRootsTo[2 * slot].xyz)) InterlockedOr(gGroupNear, 1u);
    }
    GroupMemoryBarrierWithGroupSync();
    const bool woken = gGroupMoved != 0u || gGroupNear != 0u || gFrame.wakeAll != 0u;
    if (slept && woken) rested = 0.0;
    if (slept && !woken) {
        // One work group of the block keeps the time.
        if (lane == 0 && gSlot == block * HAIRLOOM_GROUP_STRANDS) {
            gRests[2 * block] = rested + gFrame.dt;
            InterlockedAdd(gReport[REPORT_ASLEEP], strands);
        }
        return;
    }
#endif
    loadState();
    // What fell asleep has no speed.
    if (slept) gPrevious = gPosition;
    enterFrame();
    if (gFrame.rescale != 1.0) rescaleMotion();
    GroupMemoryBarrierWithGroupSync();
    runSubsteps();
    finishStrand(strands);
    saveState();
    writePlace();
    ONLY_POINT(0) leaveFrame();
    if (lane == 0) {
        if (gGroupRestored == 0u) InterlockedMax(gReport[REPORT_FASTEST], gGroupFastest);
#if HAIR_SLEEP
        judgeBlock(block, strands, rested);
#endif
    }
}
