// SPDX-License-Identifier: GPL-3.0-or-later
// One value into all words of a buffer.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { FillConstants gFill; };
RWStructuredBuffer<uint> gTarget : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gFill.rowThreads;
    if (id.x < gFill.rowThreads && index < gFill.elements) gTarget[index] = gFill.value;
}
