// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates a model, included before, on given cases: single scattering first, then what dual scattering adds.
#include "shaders/render/dual.hlsli"
#ifdef HAIRLOOM_LOOK
#include "shaders/render/look.hlsli"
#endif

cbuffer Fibre : register(b1) { FibreConstants gFibre; };
StructuredBuffer<FibreCase> gCases : register(t0);
RWStructuredBuffer<float4> gResults : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint count, stride;
    gCases.GetDimensions(count, stride);
    if (id.x >= count) return;
    const FibreCase c = gCases[id.x];
    const FibreFrame f = fibreFrame(c.tangent.xyz, c.toLight.xyz, c.toView.xyz);
#ifdef HAIRLOOM_LOOK
    StrandPlace place;
    place.along = c.place.x;
    place.streak = c.place.y;
    place.dye = c.place.z;
    place.random = c.place.w;
    place.pigment = c.strand.x;
    place.length = c.strand.y;
    place.own = c.own;
    const float3 absorption = lookAt(place);
#else
    const float3 absorption = 0;
#endif
    gResults[2 * id.x] = float4(fibreScattering(gFibre, f, c.tangent.w, 1.0, absorption), absorption.x);
    gResults[2 * id.x + 1] =
        float4(multipleScattering(gFibre, f, c.toLight.w, c.toView.w, 1.0, absorption, c.ground.rgb), absorption.y);
}
