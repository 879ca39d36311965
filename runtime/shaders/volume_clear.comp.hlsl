// SPDX-License-Identifier: MIT
// Empties the nodes that are in use.
#include "volume.hlsli"

StructuredBuffer<uint> gBox : register(t0);
RWStructuredBuffer<uint> gNodes : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    uint box[8];
    [unroll] for (uint i = 0; i < 8; ++i) box[i] = gBox[i];
    const Grid grid = gridOf(box);
    if (thread.x >= nodeCount(grid)) return;
    [unroll] for (uint word = 0; word < NODE_WORDS; ++word) gNodes[thread.x * NODE_WORDS + word] = 0u;
}
