// SPDX-License-Identifier: GPL-3.0-or-later
// A pixel's nearest fragments of hair over the mean of its samples, added to the sum of frames. Light of hair behind the last
// fragment that was kept falls with depth as it does from the nearer half of those that were to the farther.
#include "shaders/render/fragments.hlsli"
#include "shaders/render/resolve.hlsli"

StructuredBuffer<uint> gDepths : register(t2);
StructuredBuffer<uint> gFragmentLight : register(t3);
StructuredBuffer<uint> gCover : register(t4);

// The light of hair that lies behind halves of these mean lights, which let `through` pass; all hair lets `least` pass.
float3 lightBehind(float3 nearer, float3 farther, float through, float least) {
    const float3 fall = clamp(farther / max(nearer, 1e-6), 1e-3, 1.0);
    const float ofHalf = max(-0.5 * log(max(through, 1e-4)), 1e-3);  // optical depth of a half
    const float depth = log(max(through, 1e-6) / max(least, 1e-6));
    // Two means of a few hairs are noisy: light falls no faster than hair hides what is behind it.
    const float3 falls = min(-log(fall) / ofHalf, 1.0);
    // The integral of farther exp(-falls (u + ofHalf / 2)) exp(-u) over the optical depth u from 0 to depth.
    return through * farther * exp(-0.5 * ofHalf * falls) * (1.0 - exp(-depth * (1.0 + falls))) / (1.0 + falls);
}

float4 hairOver(float4 behind, uint pixel) {
    const uint base = pixel * HAIRLOOM_FRAGMENTS;
    const uint covers = pixel * HAIRLOOM_COVER_WORDS;
    float through = 1.0;
    float3 light = 0;
    float4 halves[2] = {(float4)0, (float4)0};
    for (uint k = 0; k < HAIRLOOM_FRAGMENTS && gDepths[base + k] < kNoFragment; ++k) {
        const float cover = unpackCover(gCover[covers + k / 2u], k);
        const float4 fragment = cover * float4(unpackLight(gFragmentLight[base + k]), 1);
        light += through * fragment.rgb;
        through *= 1.0 - cover;
        halves[k / (HAIRLOOM_FRAGMENTS / 2u)] += fragment;
    }
    const float least = min(letThrough(gCover[stepsOf(pixel)]), through);
    if (halves[1].w > 0.0) {
        const float3 nearer = halves[0].rgb / halves[0].w;
        const float3 farther = halves[1].rgb / halves[1].w;
        light += lightBehind(nearer, farther, through, least);
        through = least;
    }
    return float4(light, 1.0 - through) + through * behind;
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint pixel = id.x + id.y * gResolve.rowThreads;
    if (id.x >= gResolve.rowThreads || pixel >= gResolve.pixels) return;
    addToSum(pixel, hairOver(meanOfSamples(pixel), pixel));
}
