// SPDX-License-Identifier: GPL-3.0-or-later
cbuffer Constants : register(b0) { uint4 gParameters; };  // x: count, y: added
StructuredBuffer<uint> gIn : register(t0);
RWStructuredBuffer<uint> gOut : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x < gParameters.x) gOut[id.x] = 2 * gIn[id.x] + gParameters.y;
}
