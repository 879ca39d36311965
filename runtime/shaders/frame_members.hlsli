// SPDX-License-Identifier: MIT
// A frame of rods that some threads share (rod_members.hlsli). A block of the engine has several work groups, so that few
// strands find many processors.
#define HAIR_THREADS (HAIR_STRANDS * HAIR_MEMBERS)
#include "serial_strand.hlsli"
#include "shared_block.hlsli"

[numthreads(HAIR_THREADS, 1, 1)]
void main(uint3 groupId : SV_GroupID, uint thread : SV_GroupIndex) {
    const uint group = groupId.y * HAIRLOOM_GROUP_ROW + groupId.x;
    if (group >= gFrame.groups) return;
    gMember = thread / HAIR_STRANDS;
    gSlot = group * HAIR_STRANDS + thread % HAIR_STRANDS;
    const uint block = gSlot / HAIRLOOM_GROUP_STRANDS, strands = gBlocks[block].y;
    gPointCount = gBlocks[block].x;
    if (thread == 0) gGroupMoved = gGroupFastest = gGroupRestored = gGroupNear = gGroupLeft = 0u;
    bool slept = false;
#if HAIR_SLEEP
    slept = gRests[restOf(block) + 1] != 0.0;
#endif
    GroupMemoryBarrierWithGroupSync();
#if HAIR_SLEEP
    if (slept) {
        lookAtRoots(block, thread);
        lookForSpheres(block, thread);
        GroupMemoryBarrierWithGroupSync();
        if (sleepsOn(block, thread, strands)) return;
    }
    lookAtRoots(block, thread);
#endif
    ALONE {
        // What fell asleep has no speed.
        if (slept) ALL_POINTS(p) setPrevious(p, position(p));
    }
    enterFrame();
    runSubsteps();
    ALONE finishStrand(block, gSlot % HAIRLOOM_GROUP_STRANDS);
    MEET
    ALONE leaveFrame();
    [loop] for (uint q = gMember; q < POINTS; q += HAIR_MEMBERS) writePosition(q);
    if (thread != 0) return;
    if (gGroupRestored == 0u) InterlockedMax(gReport[REPORT_FASTEST], gGroupFastest);
#if HAIR_SLEEP
    judgeBlock(block, strands);
#endif
}
