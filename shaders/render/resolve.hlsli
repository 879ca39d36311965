// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of a pixel's samples, and the sum of frames.
#ifndef HAIRLOOM_RESOLVE_HLSLI
#define HAIRLOOM_RESOLVE_HLSLI
#include "shaders/render/raster.hlsli"

cbuffer Constants : register(b0) { ResolveConstants gResolve; };
StructuredBuffer<uint> gNearest : register(t0);
StructuredBuffer<uint> gLight : register(t1);
RWStructuredBuffer<float4> gSum : register(u0);

float4 meanOfSamples(uint pixel) {
    const uint samples = gResolve.samples;
    float4 mean = 0;
    for (uint s = 0; s < samples; ++s) {
        const uint at = pixel * samples + s;
        const bool nothing = asfloat(gNearest[at]) >= 1.0;
        mean += nothing ? gResolve.background : float4(unpackLight(gLight[at]), 1);
    }
    return mean / float(samples);
}

void addToSum(uint pixel, float4 frame) {
    gSum[pixel] = gResolve.sumBegins != 0u ? frame : gSum[pixel] + frame;
}
#endif
