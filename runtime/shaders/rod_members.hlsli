// SPDX-License-Identifier: MIT
// How the HAIR_MEMBERS threads that share a rod work together: what each segment can do by itself they do side by side, sums
// along the strand they make of each other's, and the chain of the elimination one does for all. Threads of one number, of
// all strands of the group, stand side by side, so that neighbours read neighbouring floats. All threads of a group come to
// each MEET together, also those of strands that have nothing to do there.

#define FIRST_SEGMENT (HAIR_CLAMPED - 1)
#define SEGMENTS (POINTS - 1)
#define EACH_SEGMENT(j) [loop] for (uint j = FIRST_SEGMENT; j < SEGMENTS; ++j)

#if HAIR_MEMBERS > 1
#define MEET AllMemoryBarrierWithGroupSync();
// Of two tellings in turn: who is late still reads the one before.
groupshared float4 gTold[4 * HAIR_MEMBERS * HAIR_STRANDS];
groupshared uint gVotes[3];
static uint gTellings, gVotings;  // so far

/// Before the first telling, by all threads.
void openMembers() {
    gTellings = gVotings = 0u;
    if (gMember == 0u && gSlot % HAIR_STRANDS == 0u) gVotes[0] = gVotes[1] = gVotes[2] = 0u;
    MEET
}

uint ownFrom(uint member) {
    const uint each = (SEGMENTS - FIRST_SEGMENT + HAIR_MEMBERS - 1) / HAIR_MEMBERS;
    return min(FIRST_SEGMENT + member * each, SEGMENTS);
}
#define OWN_SEGMENTS(j) [loop] for (uint j = ownFrom(gMember); j < ownFrom(gMember + 1); ++j)
uint toldAt(uint which, uint member) {
    return ((gTellings % 2u * 2u + which) * HAIR_MEMBERS + member) * HAIR_STRANDS + gSlot % HAIR_STRANDS;
}
/// All memory that the threads of the group wrote before is there for all of them behind it.
void tell(float4 first, float4 second) {
    ++gTellings;
    gTold[toldAt(0, gMember)] = first;
    gTold[toldAt(1, gMember)] = second;
    MEET
}
/// Of what the members of the strand have: the sums of the first, the largest of the second.
void join(inout float4 sums, inout float4 largest) {
    tell(sums, largest);
    sums = float4(0, 0, 0, 0);
    [loop] for (uint m = 0; m < HAIR_MEMBERS; ++m) {
        sums += gTold[toldAt(0, m)];
        largest = max(largest, gTold[toldAt(1, m)]);
    }
}
/// Two ways along the strand: what the members before this one have is added to each.
void addThoseBefore(float3 first, float3 second, inout float3 toFirst, inout float3 toSecond) {
    tell(float4(first, 0.0), float4(second, 0.0));
    [loop] for (uint m = 0; m < gMember; ++m) {
        toFirst += gTold[toldAt(0, m)].xyz;
        toSecond += gTold[toldAt(1, m)].xyz;
    }
}
/// Whether any thread of the group says so. Of three votes in turn one is cleared that all have read.
bool anyOf(bool mine) {
    const uint now = gVotings % 3u;
    if (mine) InterlockedOr(gVotes[now], 1u);
    MEET
    if (gMember == 0u && gSlot % HAIR_STRANDS == 0u) gVotes[(now + 2u) % 3u] = 0u;
    ++gVotings;
    return gVotes[now] != 0u;
}
#else
#define MEET
#define OWN_SEGMENTS(j) EACH_SEGMENT(j)
void openMembers() {}
void join(inout float4 sums, inout float4 largest) {}
bool anyOf(bool mine) { return mine; }
#endif
