// SPDX-License-Identifier: GPL-3.0-or-later
// One value into all words of a buffer.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { FillConstants gFill; };
RWStructuredBuffer<uint> gTarget : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gFill.numbers.z;
    if (id.x < gFill.numbers.z && index < gFill.numbers.y) gTarget[index] = gFill.numbers.x;
}
