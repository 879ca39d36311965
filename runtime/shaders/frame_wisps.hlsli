// SPDX-License-Identifier: MIT
// A work group for each wisp (Rünz 2012, Section 6.1): its first thread takes the strand, which stays in the memory of
// the group, through the frame; the others wait for it, then write its positions.

#include "serial_strand.hlsli"

[numthreads(1, HAIR_THREADS, 1)]
void main(uint3 groupId : SV_GroupID, uint lane : SV_GroupIndex) {
    const uint group = groupId.y * HAIRLOOM_GROUP_ROW + groupId.x;
    if (group >= gFrame.groups) return;
    gSlot = group;
    gStrand = 0;
    const uint block = group / HAIRLOOM_GROUP_STRANDS, strands = gBlocks[block].y;
#if !HAIR_EXACT
    gPointCount = gBlocks[block].x;
#endif
    if (lane == 0) gGroupMoved = gGroupFastest = gGroupRestored = gGroupNear = gGroupLeft = 0u;
    // All threads come to each barrier, also where a block sleeps: Microsoft's compiler takes none behind a branch on what a
    // buffer holds.
    bool runs = true, slept = false;
#if HAIR_SLEEP
    slept = gRests[restOf(block) + 1] != 0.0;
    GroupMemoryBarrierWithGroupSync();
    lookAtRoots(block, lane);
    if (slept) lookForSpheres(block, lane);
#endif
    GroupMemoryBarrierWithGroupSync();
#if HAIR_SLEEP
    if (slept) runs = !sleepsOn(block, lane, strands);
#endif
    if (runs && lane == 0) {
        loadState();
        // What fell asleep has no speed.
        if (slept) {
            EACH for (uint p = 0; p < POINTS; ++p) setPrevious(p, position(p));
        }
        enterFrame();
        if (gFrame.rescale != 1.0) rescaleMotion();
        runSubsteps();
        finishStrand(block, group % HAIRLOOM_GROUP_STRANDS);
        saveState();
        leaveFrame();
        if (gGroupRestored == 0u) InterlockedMax(gReport[REPORT_FASTEST], gGroupFastest);
#if HAIR_SLEEP
        judgeBlock(block, strands);
#endif
    }
    GroupMemoryBarrierWithGroupSync();
    if (runs) {
        [loop] for (uint q = lane; q < POINTS; q += HAIR_THREADS) writePosition(q);
    }
}
