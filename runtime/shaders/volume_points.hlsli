// SPDX-License-Identifier: MIT
// The points of a batch, a thread each, as storage.hlsli lays them out.
#include "math.hlsli"
#include "volume.hlsli"

StructuredBuffer<uint2> gBlocks : register(t0);
StructuredBuffer<uint> gFirstPoints : register(t1);
StructuredBuffer<float> gRoots : register(t2);

/// What a thread has to do with.
struct Point {
    uint slot, p;
    bool counts;  // a point of a strand, not filling
};
Point pointOf(uint thread) {
    Point result;
    const uint side = gVolume.together != 0u ? max(gVolume.points, 1u) : gVolume.slots;
    const uint outer = thread / side, inner = thread % side;
    result.p = gVolume.together != 0u ? inner : outer;
    result.slot = gVolume.together != 0u ? outer : inner;
    result.counts = result.p < gVolume.points && result.slot < gVolume.slots && result.p < gBlocks[result.slot / 32].x &&
                    gFirstPoints[result.slot] != 0xffffffffu;
    return result;
}
uint planeSlot(uint plane, Point at) {
    return gVolume.together != 0u ? (plane * gVolume.slots + at.slot) * gVolume.points + at.p
                                  : (plane * gVolume.points + at.p) * gVolume.slots + at.slot;
}
float3 rootOf(Point at) {
    return float3(gRoots[at.slot], gRoots[gVolume.slots + at.slot], gRoots[2 * gVolume.slots + at.slot]);
}
bool takesPart(float3 position, float3 velocity) {
    return isSound(position) && isSound(velocity) && all(abs(position) <= FARTHEST);
}
