// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b1) { MeshConstants gMesh; };
StructuredBuffer<float4> gPositions : register(t0);
StructuredBuffer<uint> gIndices : register(t2);

float4 main(uint corner : SV_VertexID) : SV_Position {
    return mul(gMesh.clipFromWorld, float4(gPositions[gIndices[corner]].xyz, 1));
}
