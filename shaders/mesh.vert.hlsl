// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b1) { MeshConstants gMesh; };
StructuredBuffer<float4> gPositions : register(t0);
StructuredBuffer<float4> gNormals : register(t1);
StructuredBuffer<uint> gIndices : register(t2);
StructuredBuffer<float4> gAlbedo : register(t3);  // per triangle

struct Output {
    float4 position : SV_Position;
    float3 position_ws : POSITION;
    float3 normal_ws : NORMAL;
    nointerpolation float3 albedo : ALBEDO;
};

Output main(uint corner : SV_VertexID) {
    const uint vertex = gIndices[corner];
    Output o;
    o.position_ws = gPositions[vertex].xyz;
    o.normal_ws = gNormals[vertex].xyz;
    o.albedo = gAlbedo[corner / 3u].rgb;
    o.position = mul(gMesh.clipFromWorld, float4(o.position_ws, 1));
    return o;
}
