// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates Marschner's fibre as the shaders of games have it: single scattering first, then all of it.
#include "shaders/shared/render_types.h"

StructuredBuffer<FibreCase> gCases : register(t0);
StructuredBuffer<float> gTables : register(t1);
#include "runtime/shaders/hair_fibre.hlsli"
#include "runtime/shaders/hair_look.hlsli"
StructuredBuffer<HairMaterial> gMaterials : register(t2);
RWStructuredBuffer<float4> gResults : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint count, stride;
    gCases.GetDimensions(count, stride);
    if (id.x >= count) return;
    const FibreCase c = gCases[id.x];
    const HairMaterial hair = gMaterials[0];
    const FibreFrame f = fibreFrame(c.tangent.xyz, c.toLight.xyz, c.toView.xyz);
    StrandPlace place;
    place.along = c.place.x;
    place.streak = c.place.y;
    place.dye = c.place.z;
    place.random = c.place.w;
    place.pigment = c.strand.x;
    place.length = c.strand.y;
    place.own = c.own;
    const float3 absorption = lookOf(hair.look, place);
    gResults[2 * id.x] = float4(fibreLight(hair, f, 0.0, 0.0, 1.0, absorption, 0.0), absorption.x);
    gResults[2 * id.x + 1] =
        float4(fibreLight(hair, f, c.toLight.w, c.toView.w, 1.0, absorption, c.ground.rgb), absorption.y);
}
