// SPDX-License-Identifier: MIT
// A frame of a strand whose points follow each other in a thread; a work group is a block of the engine.
#include "serial_strand.hlsli"

[numthreads(HAIR_STRANDS, 1, 1)]
void main(uint3 group : SV_GroupID, uint lane : SV_GroupIndex) {
    const uint block = group.y * HAIRLOOM_GROUP_ROW + group.x;
    if (block >= gFrame.groups) return;
    gSlot = block * HAIR_STRANDS + lane;
#if HAIR_STORAGE == 1
    gStrand = lane;
#endif
#if !HAIR_EXACT
    gPointCount = gBlocks[block].x;
#endif
    if (lane == 0) gGroupMoved = gGroupFastest = gGroupRestored = gGroupNear = gGroupLeft = 0u;
    GroupMemoryBarrierWithGroupSync();
    if (rootMoves(gSlot)) InterlockedOr(gGroupMoved, 1u);
    bool runs = true;
#if HAIR_SLEEP
    // Read by all before the last barrier, written by one after it.
    const uint rest = restOf(block);
    float rested = gRests[rest], stayed = gRests[rest + 2];
    bool asleep = gRests[rest + 1] != 0.0;
    if (asleep && sphereNear(gRootsTo[2 * gSlot].xyz)) InterlockedOr(gGroupNear, 1u);
    GroupMemoryBarrierWithGroupSync();
    if (asleep && (gGroupMoved != 0u || gGroupNear != 0u || gFrame.wakeAll != 0u)) {
        asleep = false;
        rested = stayed = 0.0;
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
        const bool stays = gGroupMoved == 0u && gGroupRestored == 0u && gGroupLeft == 0u && gFrame.wakeAll == 0u;
        asleep = fallsAsleep(slow, stays, rested, stayed);
        if (asleep) {
            EACH for (uint p = 0; p < POINTS; ++p) setPrevious(p, position(p));
        }
    } else {
        rested += gFrame.dt;
    }
    if (lane == 0) {
        keepRest(block, rested, asleep, stayed);
        if (asleep) InterlockedAdd(gReport[REPORT_ASLEEP], gBlocks[block].y);
    }
#endif
    if (runs) {
        saveState();
        leaveFrame();
        EACH for (uint q = 0; q < POINTS; ++q) writePosition(q);
        if (lane == 0 && gGroupRestored == 0u) InterlockedMax(gReport[REPORT_FASTEST], gGroupFastest);
    }
}
