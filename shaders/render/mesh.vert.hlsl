// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b1) { MeshConstants gMesh; };
StructuredBuffer<float> gPositions : register(t0);  // three a vertex
StructuredBuffer<float> gNormals : register(t1);
StructuredBuffer<uint> gIndices : register(t2);
StructuredBuffer<float> gAlbedo : register(t3);

struct Output {
    float4 position : SV_Position;
    float3 position_ws : POSITION;
    float3 normal_ws : NORMAL;
    float3 albedo : ALBEDO;
};

Output main(uint corner : SV_VertexID) {
    const uint at = 3u * gIndices[corner];
    Output o;
    o.position_ws = float3(gPositions[at], gPositions[at + 1u], gPositions[at + 2u]);
    o.normal_ws = float3(gNormals[at], gNormals[at + 1u], gNormals[at + 2u]);
    o.albedo = float3(gAlbedo[at], gAlbedo[at + 1u], gAlbedo[at + 2u]);
    o.position = mul(gMesh.clipFromWorld, float4(o.position_ws, 1));
    return o;
}
