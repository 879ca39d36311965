// SPDX-License-Identifier: MIT
// A block of the engine whose strands are in several work groups, and which falls asleep as one: each group leaves what
// it has seen, and the last of them judges.
#if HAIR_SLEEP

// The threads of a group share the strands of their block.
#if HAIR_THREADS == HAIRLOOM_GROUP_STRANDS
#define STRANDS_OF_BLOCK(s) [unroll] for (uint s = lane, turn = 0u; turn < 1u; ++turn)
#else
#define STRANDS_OF_BLOCK(s) [loop] for (uint s = lane; s < HAIRLOOM_GROUP_STRANDS; s += HAIR_THREADS)
#endif

/// Looks, with all threads of the group, whether a root of the block moves in this frame.
void lookAtRoots(uint block, uint lane) {
    STRANDS_OF_BLOCK(s) {
        if (rootMoves(block * HAIRLOOM_GROUP_STRANDS + s)) InterlockedOr(gGroupMoved, 1u);
    }
}

/// Looks, with all threads of the group, whether a sphere that has changed comes near a strand of the block.
void lookForSpheres(uint block, uint lane) {
    STRANDS_OF_BLOCK(s) {
        if (sphereNear(gRootsTo[2 * (block * HAIRLOOM_GROUP_STRANDS + s)].xyz)) InterlockedOr(gGroupNear, 1u);
    }
}

/// Whether a block that was asleep stays so in this frame, to which each of its work groups comes alike, after both looks and a
/// barrier.
bool sleepsOn(uint block, uint lane, uint strands) {
    const uint rest = restOf(block);
    if (gGroupMoved != 0u || gGroupNear != 0u || gFrame.wakeAll != 0u) {
        if (lane == 0) gRests[rest] = gRests[rest + 2] = 0.0;
        return false;
    }
    // One work group of the block keeps the time.
    if (lane == 0 && gSlot == block * HAIRLOOM_GROUP_STRANDS) {
        gRests[rest] += gFrame.dt;
        InterlockedAdd(gReport[REPORT_ASLEEP], strands);
    }
    return true;
}

// In what is gathered of a block: what groups that are not slow count besides, and those whose strands do not stay.
#define NOT_SLOW 0x100u
#define NOT_STAYING 0x10000u

/// What the first thread of each work group of a block leaves, and what the last of them makes of it.
void judgeBlock(uint block, uint strands) {
    const bool still = gGroupMoved == 0u && gGroupRestored == 0u;
    const bool slow = still && asfloat(gGroupFastest) < gFrame.slowSquared;
    const bool stays = still && gGroupLeft == 0u && gFrame.wakeAll == 0u;
    uint gathered;
    const uint own = 1u + (slow ? 0u : NOT_SLOW) + (stays ? 0u : NOT_STAYING);
    InterlockedAdd(gGathered[block], own, gathered);
    gathered += own;
    if (gathered % NOT_SLOW < HAIRLOOM_GROUP_STRANDS / HAIR_STRANDS) return;
    gGathered[block] = 0u;
    const uint rest = restOf(block);
    float rested = gRests[rest], stayed = gRests[rest + 2];
    const bool asleep = fallsAsleep(gathered % NOT_STAYING < NOT_SLOW, gathered < NOT_STAYING, rested, stayed);
    keepRest(block, rested, asleep, stayed);
    if (asleep) InterlockedAdd(gReport[REPORT_ASLEEP], strands);
}
#endif
