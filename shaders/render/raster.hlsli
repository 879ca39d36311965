// SPDX-License-Identifier: GPL-3.0-or-later
// Rasterising in compute kernels. Hair is many pieces of a pixel's width, for which fixed-function rasterisers are not
// made (Tafuri 2019, strand-based hair in Frostbite), and some devices have far more compute than graphics units. A
// sample is a 32-bit word: the least depth as its bits, then the light of what has that depth, the larger word where two
// have the same, so that no order of threads shows.
#ifndef HAIRLOOM_RASTER_HLSLI
#define HAIRLOOM_RASTER_HLSLI
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

float powerOfTwo(int n) { return asfloat(uint(127 + n) << 23u); }

// Three mantissas of 9 bits and one exponent, up to 65,408; off by at most 1 / 1,022 of the largest channel.
uint packLight(float3 light) {
    const float3 l = clamp(light, 0.0, 65408.0);
    const float maximum = max(l.x, max(l.y, l.z));
    int exponent = max(int(asuint(maximum) >> 23u) - 127, -16) + 16;
    if (uint(maximum * powerOfTwo(24 - exponent) + 0.5) > 511u) exponent += 1;
    const uint3 m = uint3(l * powerOfTwo(24 - exponent) + 0.5);
    return (uint(exponent) << 27u) | (m.z << 18u) | (m.y << 9u) | m.x;
}

float3 unpackLight(uint packed) {
    const uint3 m = uint3(packed, packed >> 9u, packed >> 18u) & 511u;
    return float3(m) * powerOfTwo(int(packed >> 27u) - 24);
}
#endif
