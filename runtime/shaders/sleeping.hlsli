// SPDX-License-Identifier: MIT
// What a work group tells its threads of a frame, and what wakes it.

groupshared uint gGroupMoved;
groupshared uint gGroupFastest;
groupshared uint gGroupRestored;
groupshared uint gGroupNear;

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
#endif
