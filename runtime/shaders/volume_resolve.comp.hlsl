// SPDX-License-Identifier: MIT
// Velocity and pressure gradient of each node. The outermost nodes hold no hair and stay without a field.
#include "volume.hlsli"

StructuredBuffer<uint> gBox : register(t0);
StructuredBuffer<uint> gNodes : register(t1);
RWStructuredBuffer<float4> gFields : register(u0);  // of each node: velocity, m/s; push, m/s²

#define MASS_UNITS 16777216.0

float massOf(uint node) {
    return float(gNodes[node * NODE_WORDS + 1]) * 4294967296.0 + float(gNodes[node * NODE_WORDS]);
}
float momentumOf(uint node, uint axis) {
    uint low = gNodes[node * NODE_WORDS + 2 + 2 * axis], high = gNodes[node * NODE_WORDS + 3 + 2 * axis];
    const bool negative = (high & 0x80000000u) != 0u;
    // The size first: halves of a small negative number are large.
    if (negative) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    const float size = float(high) * 4294967296.0 + float(low);
    return negative ? -size : size;
}
float pressureAt(uint node, float cell) {
    const float density = massOf(node) / MASS_UNITS / (cell * cell * cell);
    return gVolume.repulsion * max(density / gVolume.targetDensity - 1.0, 0.0);
}

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    uint box[8];
    [unroll] for (uint i = 0; i < 8; ++i) box[i] = gBox[i];
    const Grid grid = gridOf(box);
    const uint node = thread.x;
    if (node >= nodeCount(grid)) return;
    const uint row = grid.size.x, slice = row * grid.size.y;
    const uint3 at = uint3(node % row, node / row % grid.size.y, node / slice);
    float3 velocity = float3(0, 0, 0), push = float3(0, 0, 0);
    const float mass = massOf(node);
    if (mass > 0.0 && all(at > uint3(0, 0, 0)) && all(at + uint3(1, 1, 1) < grid.size)) {
        velocity = float3(momentumOf(node, 0), momentumOf(node, 1), momentumOf(node, 2)) * (grid.unit / mass);
        push = float3(pressureAt(node - 1, grid.cell) - pressureAt(node + 1, grid.cell),
                      pressureAt(node - row, grid.cell) - pressureAt(node + row, grid.cell),
                      pressureAt(node - slice, grid.cell) - pressureAt(node + slice, grid.cell)) *
               (0.5 / grid.cell);
    }
    gFields[2 * node] = float4(velocity, 0);
    gFields[2 * node + 1] = float4(push, 0);
}
