// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/skin.hlsli"

cbuffer Mesh : register(b1) { MeshConstants gMesh; };

struct Input {
    float4 position : SV_Position;
    float3 position_ws : POSITION;
    float3 normal_ws : NORMAL;
    float3 albedo : ALBEDO;
};

float4 main(Input i) : SV_Target0 {
    return float4(skinLight(gMesh, i.position_ws, i.normal_ws, i.albedo), 1);
}
