// SPDX-License-Identifier: GPL-3.0-or-later
// Rasterising in compute kernels. Hair is many pieces of a pixel's width, for which fixed-function rasterisers are not
// made (Tafuri 2019, strand-based hair in Frostbite), and some devices have far more compute than graphics units. A
// sample is a 32-bit word: the least depth as its bits, then the light of what has that depth, the larger word where two
// have the same, so that no order of threads shows.
#ifndef HAIRLOOM_RASTER_HLSLI
#define HAIRLOOM_RASTER_HLSLI
#include "shaders/render/pack_light.hlsli"
#include "shaders/shared/render_types.h"

cbuffer Raster : register(b2) { RasterConstants gRaster; };

// From the middle of a pixel.
float2 samplePlace(uint s) {
    const float4 two = gRaster.samplePositions[s >> 1u];
    return (s & 1u) != 0u ? two.zw : two.xy;
}

// In pixels of the buffer, y down.
float2 onBuffer(float4 clip) {
    return gRaster.window.xy + (0.5 + 0.5 * float2(clip.x, -clip.y) / clip.w) * gRaster.window.zw;
}

uint pixelIndex(int2 pixel) { return uint(pixel.y) * gRaster.bufferWidth + uint(pixel.x); }
#endif
