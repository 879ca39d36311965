// SPDX-License-Identifier: MIT
// Adds each point to the eight nodes around it.
#include "volume_points.hlsli"

StructuredBuffer<float> gState : register(t3);
StructuredBuffer<uint> gBox : register(t4);
RWStructuredBuffer<uint> gNodes : register(u0);

/// Adds a 64-bit number to a sum in two words: the carry follows from what the low one was.
void add(uint word, uint low, uint high) {
    uint before;
    InterlockedAdd(gNodes[word], low, before);
    const uint carry = before + low < before ? 1u : 0u;
    if (high + carry != 0u) InterlockedAdd(gNodes[word + 1], high + carry);
}

/// value · 2^shift as 64 bits, 0 < shift < 32, added to low and high.
void addShifted(int value, uint shift, inout uint low, inout uint high) {
    const uint part = uint(value) << shift;
    const uint sum = low + part;
    high += uint(value >> (32 - int(shift))) + (sum < low ? 1u : 0u);
    low = sum;
}

/// weight · value, of up to 24 bits each, value signed.
void addProduct(uint word, uint weight, int value) {
    const int weightHigh = int(weight >> 12), weightLow = int(weight & 4095u);
    const int valueHigh = value >> 12, valueLow = value & 4095;
    const int minimum = weightLow * valueLow;
    uint low = uint(minimum), high = 0u;
    addShifted(weightHigh * valueLow + weightLow * valueHigh, 12u, low, high);
    addShifted(weightHigh * valueHigh, 24u, low, high);
    add(word, low, high);
}

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const Point at = pointOf(thread.x);
    if (!at.counts) return;
    const float3 here = float3(gState[planeSlot(0, at)], gState[planeSlot(1, at)], gState[planeSlot(2, at)]);
    const float3 before = float3(gState[planeSlot(3, at)], gState[planeSlot(4, at)], gState[planeSlot(5, at)]);
    const float3 position = rootOf(at) + here;
    const float3 velocity = (here - before) / gVolume.h;
    if (!takesPart(position, velocity)) return;
    uint box[8];
    [unroll] for (uint i = 0; i < 8; ++i) box[i] = gBox[i];
    const Grid grid = gridOf(box);
    const Place place = placeOf(position, grid);
    const int3 whole = int3(round(clamp(velocity, -FASTEST, FASTEST) / grid.unit));
    [loop] for (uint corner = 0; corner < 8; ++corner) {
        const uint weight = weightOf(place, corner);
        if (weight == 0u) continue;
        const uint word = nodeOf(place, corner, grid) * NODE_WORDS;
        add(word, weight, 0u);
        addProduct(word + 2, weight, whole.x);
        addProduct(word + 4, weight, whole.y);
        addProduct(word + 6, weight, whole.z);
    }
}
