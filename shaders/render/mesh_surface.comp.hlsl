// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that lie nearest in the middle of a pixel.
#include "shaders/render/triangle_raster.hlsli"
#include "shaders/render/surface.hlsli"

StructuredBuffer<float> gPast : register(t1);
StructuredBuffer<float> gAlbedo : register(t3);

void visitPixel(Corners c, int2 pixel, uint face) {
    const float2 middle = float2(pixel - c.origin) + 0.5;
    const float depth = depthAt(c, middle);
    if (depth < 0.0 || depth > 1.0) return;
    const uint at = pixelIndex(pixel);
    if (!isShown(at, depth, gSurface.firstItem + face)) return;
    const float3 shares = sharesOfFace(c, middle);
    const float3 position_ws = onFace(gPositions, face, shares);
    const float3 past_ws = gSurface.pastStrands > 0u ? onFace(gPast, face, shares) : position_ws;
    gFound[at] = surfaceAt(position_ws, past_ws, HAIRLOOM_NO_STRAND, onFace(gAlbedo, face, shares));
}
