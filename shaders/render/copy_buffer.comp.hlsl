// SPDX-License-Identifier: GPL-3.0-or-later
// Copies a buffer: what a kernel reaches of the memory's bandwidth.
#include "shaders/shared/group_sizes.h"

StructuredBuffer<float4> gFrom : register(t0);
RWStructuredBuffer<float4> gTo : register(u0);

[numthreads(HAIRLOOM_COPY_GROUP, 1, 1)]
void main(uint3 group : SV_GroupID, uint lane : SV_GroupIndex) {
    const uint at = (group.y * HAIRLOOM_COPY_ROW + group.x) * HAIRLOOM_COPY_GROUP + lane;
    gTo[at] = gFrom[at];
}
