// SPDX-License-Identifier: GPL-3.0-or-later
// Copies a buffer: what a kernel reaches of the memory's bandwidth.
StructuredBuffer<float4> gFrom : register(t0);
RWStructuredBuffer<float4> gTo : register(u0);

[numthreads(256, 1, 1)]
void main(uint3 group : SV_GroupID, uint lane : SV_GroupIndex) {
    const uint at = (group.y * 65535u + group.x) * 256u + lane;
    gTo[at] = gFrom[at];
}
