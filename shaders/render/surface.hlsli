// SPDX-License-Identifier: GPL-3.0-or-later
// What lies nearest in the middle of each pixel, found by kernels in three phases that are one kernel, so that they agree to
// the bit: the least depth; of what has it the first by number, so that no order of threads shows; and what it is.
#ifndef HAIRLOOM_SURFACE_HLSLI
#define HAIRLOOM_SURFACE_HLSLI
#include "shaders/render/raster.hlsli"

cbuffer Surface : register(b3) { SurfaceConstants gSurface; };
RWStructuredBuffer<uint> gNearest : register(u0);
RWStructuredBuffer<uint> gItem : register(u1);
RWStructuredBuffer<SurfacePixel> gFound : register(u2);

// Whether the pixel shows what has this depth there, for the last phase.
bool isShown(uint pixel, float depth, uint item) {
    const uint bits = asuint(depth);
    bool shown = false;
    if (gRaster.phase == HAIRLOOM_PHASE_NEAREST) {
        if (bits < gNearest[pixel]) InterlockedMin(gNearest[pixel], bits);
    } else if (gRaster.phase == HAIRLOOM_PHASE_ITEM) {
        if (bits == gNearest[pixel]) InterlockedMin(gItem[pixel], item);
    } else {
        shown = gItem[pixel] == item;
    }
    return shown;
}

float2 onScreen(float4x4 clipFromWorld, float3 position_ws) {
    const float4 clip = mul(clipFromWorld, float4(position_ws, 1));
    return onBuffer(float4(clip.xy, clip.z, max(clip.w, 1e-6)));
}

SurfacePixel surfaceAt(float3 position_ws, float3 past_ws, uint strand, float3 albedo) {
    SurfacePixel found;
    found.depth = dot(gSurface.forward_ws.xyz, position_ws) + gSurface.forward_ws.w;
    found.strand = strand;
    const float2 moved =
        onScreen(gSurface.clipFromWorld, position_ws) - onScreen(gSurface.pastClipFromWorld, past_ws);
    found.velocityX = moved.x;
    found.velocityY = moved.y;
    found.albedo = float4(albedo, 1);
    found.pastDepth = dot(gSurface.pastForward_ws.xyz, past_ws) + gSurface.pastForward_ws.w;
    found.unused0 = found.unused1 = found.unused2 = 0;
    return found;
}
#endif
