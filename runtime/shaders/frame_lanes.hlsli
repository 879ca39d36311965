// SPDX-License-Identifier: MIT
// A frame of strands spread over the threads of a work group.

groupshared uint gGroup;
#if HAIR_WAVE && HAIR_THREADS > HAIR_WAVE
groupshared uint gWaves;  // that have come
#endif
groupshared uint gStrandFastest[HAIR_STRANDS];
groupshared uint gStrandLost[HAIR_STRANDS];

/// Gives the thread its place in the group. Which threads a wave has is the device's own business, so that with HAIR_WAVE waves
/// take places as they come.
void setThreadInGroup(uint index) {
    gThreadInGroup = gLane = index;
#if HAIR_WAVE
    gThreadInGroup = gLane = WaveGetLaneIndex();
#if HAIR_THREADS > HAIR_WAVE
    if (index == 0) gWaves = 0u;
    GroupMemoryBarrierWithGroupSync();
    uint wave = 0u;
    if (gLane == 0) InterlockedAdd(gWaves, 1u, wave);
    gThreadInGroup += WaveReadLaneFirst(wave) * HAIR_WAVE;
#endif
#endif
}

/// Who the thread is.
void enterLane(uint group) {
    gStrand = gThreadInGroup / STRAND_THREADS;
    gThread = gLane % STRAND_THREADS;
    gFirst = gLane - gThread;
#if !HAIR_WAVE
    gSide = gAsked = 0u;
#endif
    gSlot = group * HAIR_STRANDS + gStrand;
#if !HAIR_EXACT
    gPointCount = gBlocks[gSlot / HAIRLOOM_GROUP_STRANDS].x;
#endif
    gInner = laneAway(-1);
    gOuter = laneAway(1);
}

/// What stays in the thread for the frame.
void loadState() {
    gInverseLengthBefore = inverseLength(gThread > 0 ? pointOf(0) - 1 : 0);
    gInverseMassAfter = inverseMass(min(pointOf(POINTS_PER_THREAD), uint(HAIR_POINTS) - 1));
    EACH_OWN_POINT(k) {
        const uint p = pointOf(k);
        gPosition[k] = savedPosition(p);
        gPrevious[k] = savedPrevious(p);
        gLength[k] = segmentLength(p);
        gInverseLength[k] = inverseOf(gLength[k]);
        gInverseMass[k] = inverseMass(p);
#if HAIR_BEND
        gStiff[k] = stiffness(p);
#endif
#if HAIR_TENSIONS
        gTension[k] = savedTension(p);
#endif
    }
}

void saveState() {
    EACH_OWN_POINT(k) {
        const uint p = pointOf(k);
        savePosition(p, gPosition[k]);
        savePrevious(p, gPrevious[k]);
#if HAIR_TENSIONS
        saveTension(p, gTension[k]);
#endif
    }
}

/// See serial_strand.hlsli.
void placeAtRest() {
    float3 at = float3(0, 0, 0);
    [loop] for (uint p = 0; p < pointOf(POINTS_PER_THREAD); ++p) {
        EACH_OWN_POINT(i) if (p == pointOf(i)) gPosition[i] = gPrevious[i] = at;
        at += rotate(gRootsTo[2 * gSlot + 1], restVector(p));
    }
#if HAIR_TENSIONS
    EACH_OWN_POINT(t) gTension[t] = 0.0;
#endif
}

/// Takes stock after the last substep.
void finishStrand(uint strands) {
    bool sound = true;
    uint maximum = 0u;
    ALL_POINTS(k) {
        const float3 here = gPosition[k], moved = here - gPrevious[k];
        const float squared = dot(moved, moved);
        sound = sound && isSound(here) && isSound(moved) && dot(here, here) < 1e12 && squared < 1e12;
        if (pointOf(k) >= FIRST_FREE) maximum = max(maximum, asuint(squared));
    }
    if (!sound) {
        InterlockedOr(gStrandLost[gStrand], 1u);
    } else {
        InterlockedMax(gStrandFastest[gStrand], maximum);
    }
    GroupMemoryBarrierWithGroupSync();
    const bool lost = gStrandLost[gStrand] != 0u;
    maximum = lost ? 0u : gStrandFastest[gStrand];
    if (lost) placeAtRest();
#if HAIR_SLEEP
    if (gFrame.wakeAll == 0u) {
        ALL_POINTS(i) {
            [unroll] for (uint a = 0; a < HAIRLOOM_REST_ANCHORS; ++a) {
                if (pointOf(i) == anchorPoint(a, POINTS)) lookAtAnchor(a, gPosition[i]);
            }
        }
    }
#endif
    ONLY_POINT(0) {
        if (lost) {
            if (gSlot % HAIRLOOM_GROUP_STRANDS < strands) InterlockedAdd(gReport[REPORT_RESTORED], 1u);
            InterlockedOr(gGroupRestored, 1u);
        }
        InterlockedMax(gGroupFastest, maximum);
    }
    GroupMemoryBarrierWithGroupSync();
}

void writePositions() {
    const uint first = gFirstPoints[gSlot];
    if (first == 0xffffffffu) return;
    const float3 root = gRootsTo[2 * gSlot].xyz;
    ALL_POINTS(k) {
        gPositions_ws[first + pointOf(k)] = float4(root + gPosition[k], 1.0);
#if HAIR_VELOCITIES
        gVelocities[first + pointOf(k)] = float4((gPosition[k] - gPrevious[k]) * (1.0 / gFrame.h), 0.0);
#endif
    }
}

[numthreads(HAIR_THREADS, 1, 1)]
void main(uint3 groupId : SV_GroupID, uint index : SV_GroupIndex) {
    const uint group = groupId.y * HAIRLOOM_GROUP_ROW + groupId.x;
    if (group >= gFrame.groups) return;
    setThreadInGroup(index);
    enterLane(group);
    const uint block = group * HAIR_STRANDS / HAIRLOOM_GROUP_STRANDS, strands = gBlocks[block].y;
    if (gThreadInGroup == 0) {
        gGroup = group;
        gGroupMoved = gGroupFastest = gGroupRestored = gGroupNear = gGroupLeft = 0u;
#if !HAIR_WAVE
        gLastAsked[0] = gLastAsked[1] = 0u;
#endif
    }
    ONLY_POINT(0) gStrandFastest[gStrand] = gStrandLost[gStrand] = 0u;
    bool slept = false;
#if HAIR_SLEEP
    slept = gRests[restOf(block) + 1] != 0.0;
#endif
    GroupMemoryBarrierWithGroupSync();
#if HAIR_SLEEP
    if (slept) {
        lookAtRoots(block, gThreadInGroup);
        lookForSpheres(block, gThreadInGroup);
        GroupMemoryBarrierWithGroupSync();
        if (sleepsOn(block, gThreadInGroup, strands)) return;
    }
#endif
    loadState();
#if HAIR_SPHERES
    startList();
#endif
    // What fell asleep has no speed.
    if (slept) gPrevious = gPosition;
    enterFrame();
    if (gFrame.rescale != 1.0) rescaleMotion();
#if HAIR_SLEEP
    lookAtRoots(block, gThreadInGroup);
#endif
    GroupMemoryBarrierWithGroupSync();
    runSubsteps();
    finishStrand(strands);
    // From the memory of the group, so that nothing that was worked out for loadState() is kept in registers through the substeps.
    enterLane(gGroup);
    saveState();
    writePositions();
    ONLY_POINT(0) leaveFrame();
    if (gThreadInGroup == 0) {
        if (gGroupRestored == 0u) InterlockedMax(gReport[REPORT_FASTEST], gGroupFastest);
#if HAIR_SLEEP
        judgeBlock(block, strands);
#endif
    }
}
