// SPDX-License-Identifier: GPL-3.0-or-later
// Hair into the nearest fragments of each pixel. A depth that is less than one that is kept takes its place and sends that on to
// the next, so that the least depths stand in their order whatever the order of threads; a second phase, which finds the same
// depths to the bit, writes their light. A fragment's cover is what the ribbon has of a square as wide as the pixel, turned along
// it: hair of a pixel's width falls off over a pixel to either side, nearly as the filter of averaged frames does.
#include "shaders/render/across.hlsli"
#include "shaders/render/fragments.hlsli"
#include "shaders/render/ribbon_raster.hlsli"

StructuredBuffer<uint> gNearest : register(t2);  // of what hides hair
RWStructuredBuffer<uint> gDepths : register(u0);
RWStructuredBuffer<uint> gLight : register(u1);
RWStructuredBuffer<uint> gCover : register(u2);

// The share of the pixel's samples in which nothing lies before the depth.
float shareInSight(uint pixel, uint depth) {
    uint count = 0;
    for (uint s = 0; s < gRaster.samples; ++s) count += gNearest[pixel * gRaster.samples + s] > depth ? 1u : 0u;
    return float(count) / float(gRaster.samples);
}

void keepDepth(uint base, uint depth) {
    uint carried = depth;
    for (uint k = 0; k < HAIRLOOM_FRAGMENTS && carried < kNoFragment; ++k) {
        if (carried >= gDepths[base + k]) continue;
        uint before;
        InterlockedMin(gDepths[base + k], carried, before);
        carried = max(carried, before);
    }
}

void visitPixel(RibbonPiece piece, int2 pixel) {
    const float2 at = fromOrigin(piece, pixel);
    if (distanceTo(piece.begins, at) < 0.0 || distanceTo(piece.ends, at) <= 0.0) return;
    const float inside = min(distanceTo(piece.left, at), distanceTo(piece.right, at));
    const float t = alongPiece(piece, at);
    const float depth = lerp(piece.depth.x, piece.depth.y, t);
    if (inside <= -0.5 || depth < 0.0 || depth >= 1.0) return;
    const uint bits = asuint(depth);
    const uint where = pixelIndex(pixel);
    const uint base = where * HAIRLOOM_FRAGMENTS;
    const uint last = gDepths[base + HAIRLOOM_FRAGMENTS - 1u];
    if (gRaster.phase != HAIRLOOM_PHASE_NEAREST && bits > last) return;
    const float share = saturate(inside + 0.5) * shareInSight(where, bits);
    const float cover = share * lerp(piece.coverage.x, piece.coverage.y, t);
    if (cover * 65535.0 < 0.5) return;
    if (gRaster.phase == HAIRLOOM_PHASE_NEAREST) {
        if (bits < last) keepDepth(base, bits);
        const uint whole = stepsOf(where);
        // What is above the most stays so: it makes no difference who sees it first.
        if (gCover[whole] < kMostSteps) InterlockedAdd(gCover[whole], halvingSteps(cover));
        return;
    }
    uint k = 0;
    while (k < HAIRLOOM_FRAGMENTS - 1u && gDepths[base + k] < bits) ++k;
    if (gDepths[base + k] != bits) return;
    const float3 light = lightOfHair(gView, piece.first, t, placeAcross(piece, at), 1.0 / pixelsAcross(piece, at));
    InterlockedMax(gLight[base + k], packLight(light));
    InterlockedOr(gCover[where * HAIRLOOM_COVER_WORDS + k / 2u], packCover(cover, k));
}
