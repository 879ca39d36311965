// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that lies nearest in the middle of a pixel.
#include "shaders/render/ribbon_raster.hlsli"
#include "shaders/render/surface.hlsli"

StructuredBuffer<float4> gAlbedo : register(t1);
StructuredBuffer<StrandHeader> gStrands : register(t2);
StructuredBuffer<CurvePoint> gPast : register(t3);

float3 between(StructuredBuffer<CurvePoint> curve, uint first, float part) {
    return lerp(curve[first].position_ws.xyz, curve[first + 1u].position_ws.xyz, part);
}

float clipW(float3 position_ws) { return mul(gView.clipFromWorld, float4(position_ws, 1)).w; }

void visitPixel(RibbonPiece piece, int2 pixel) {
    const float t = placeOn(piece, fromOrigin(piece, pixel));
    const float depth = lerp(piece.depth.x, piece.depth.y, t);
    if (t < 0.0 || depth < 0.0 || depth > 1.0) return;
    const uint at = pixelIndex(pixel);
    if (!isShown(at, depth, gSurface.firstItem + piece.first)) return;
    // What is even along the strand is not so on the screen where one end is nearer.
    const float near = (1.0 - t) * clipW(gCurve[piece.first + 1u].position_ws.xyz);
    const float far = t * clipW(gCurve[piece.first].position_ws.xyz);
    const float part = far / max(near + far, 1e-12);
    const float3 position_ws = between(gCurve, piece.first, part);
    float3 past_ws = position_ws;
    if (piece.strand < gSurface.pastStrands) past_ws = between(gPast, piece.first, part);
    const float3 albedo = lerp(gAlbedo[piece.first].rgb, gAlbedo[piece.first + 1u].rgb, part);
    const uint strand = gSurface.firstStrand + gStrands[piece.strand].source;
    gFound[at] = surfaceAt(position_ws, past_ws, strand, albedo);
}
