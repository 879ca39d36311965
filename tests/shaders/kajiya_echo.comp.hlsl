// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates the shading functions on given cases: x diffuse, y specular times the normalisation.
#include "kajiya.hlsli"
#include "shaders/shared/render_types.h"

StructuredBuffer<KajiyaCase> gCases : register(t0);
RWStructuredBuffer<float4> gResults : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint count, stride;
    gCases.GetDimensions(count, stride);
    if (id.x >= count) return;
    const KajiyaCase c = gCases[id.x];
    const float specular = kajiyaSpecular(c.tangent.xyz, c.toLight.xyz, c.toView.xyz, c.toLight.w);
    gResults[id.x] = float4(kajiyaDiffuse(c.tangent.xyz, c.toLight.xyz), specular * c.toView.w, 0, 0);
}
