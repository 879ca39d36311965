// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b1) { MeshConstants gMesh; };
StructuredBuffer<float> gPositions : register(t0);  // three a vertex
StructuredBuffer<uint> gIndices : register(t2);

float4 main(uint corner : SV_VertexID) : SV_Position {
    const uint at = 3u * gIndices[corner];
    return mul(gMesh.clipFromWorld, float4(gPositions[at], gPositions[at + 1u], gPositions[at + 2u], 1));
}
