// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of a pixel's samples, added to the sum of frames.
#include "shaders/render/raster.hlsli"

cbuffer Constants : register(b0) { ResolveConstants gResolve; };
StructuredBuffer<uint> gNearest : register(t0);
StructuredBuffer<uint> gLight : register(t1);
RWStructuredBuffer<float4> gSum : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint pixel = id.x + id.y * gResolve.rowThreads;
    if (id.x >= gResolve.rowThreads || pixel >= gResolve.pixels) return;
    const uint samples = gResolve.samples;
    float4 mean = 0;
    for (uint s = 0; s < samples; ++s) {
        const uint at = pixel * samples + s;
        const bool nothing = asfloat(gNearest[at]) >= 1.0;
        mean += nothing ? gResolve.background : float4(unpackLight(gLight[at]), 1);
    }
    mean /= float(samples);
    gSum[pixel] = gResolve.sumBegins != 0u ? mean : gSum[pixel] + mean;
}
