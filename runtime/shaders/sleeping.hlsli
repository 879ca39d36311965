// SPDX-License-Identifier: MIT
// What a work group tells its threads of a frame, and what wakes it.

groupshared uint gGroupMoved;
groupshared uint gGroupFastest;
groupshared uint gGroupRestored;
groupshared uint gGroupNear;
groupshared uint gGroupLeft;  // not 0: a point has left its anchor

/// Whether the root of a slot moves in this frame.
bool rootMoves(uint slot) { return gRootsTo[2 * slot].w != 0.0; }

#if HAIR_SLEEP
StructuredBuffer<float4> gWaking : register(t8);  // centre and reach of spheres that have changed

/// Whether a sphere that has changed since the last frame comes within reach of a strand whose root rests there.
bool sphereNear(float3 root) {
    bool near = false;
    [loop] for (uint i = 0; i < gFrame.wakingCount; ++i) {
        const float3 gap = root - gWaking[i].xyz;
        near = near || dot(gap, gap) < gWaking[i].w * gWaking[i].w;
    }
    return near;
}

/// Where the numbers of a block are in gRests.
uint restOf(uint block) { return HAIRLOOM_REST_NUMBERS * block; }

/// Leaves how a block rests to the next frame.
void keepRest(uint block, float rested, bool asleep, float stayed) {
    const uint rest = restOf(block);
    gRests[rest] = rested;
    gRests[rest + 1] = asleep ? 1.0 : 0.0;
    gRests[rest + 2] = stayed;
    gRests[rest + 3] = stayed > 0.0 ? 0.0 : 1.0;
}

/// The point of a strand whose anchor that is.
uint anchorPoint(uint anchor, uint points) { return (points - 1) * (anchor + 1) / HAIRLOOM_REST_ANCHORS; }

/// Looks whether a point of the strand is where its anchor says, or moves the anchor there.
void lookAtAnchor(uint anchor, float3 at) {
    const uint block = gSlot / HAIRLOOM_GROUP_STRANDS, blocks = gFrame.slots / HAIRLOOM_GROUP_STRANDS;
    const uint x = HAIRLOOM_REST_NUMBERS * blocks + 3 * HAIRLOOM_GROUP_STRANDS * (HAIRLOOM_REST_ANCHORS * block + anchor) +
                   gSlot % HAIRLOOM_GROUP_STRANDS;
    const uint y = x + HAIRLOOM_GROUP_STRANDS, z = y + HAIRLOOM_GROUP_STRANDS;
    if (gRests[restOf(block) + 3] != 0.0) {
        gRests[x] = at.x;
        gRests[y] = at.y;
        gRests[z] = at.z;
        return;
    }
    const float3 away = at - float3(gRests[x], gRests[y], gRests[z]);
    const float delays = gFrame.sleepDelay / gFrame.h;
    if (!(dot(away, away) < gFrame.slowSquared * delays * delays)) InterlockedOr(gGroupLeft, 1u);
}

/// Whether a block falls asleep at the end of a frame in which it was slow, or in which all of its points stayed at their anchors.
bool fallsAsleep(bool slow, bool stays, inout float rested, inout float stayed) {
    rested = slow ? rested + gFrame.dt : 0.0;
    stayed = stays ? stayed + gFrame.dt : 0.0;
    if (slow && rested >= gFrame.sleepDelay) return true;
    if (stayed <= HAIRLOOM_STAY_DELAYS * gFrame.sleepDelay) return false;
    rested = stayed;
    return true;
}
#endif
