// SPDX-License-Identifier: GPL-3.0-or-later
// Hair into the samples of a frame. Both phases are one kernel, so that they find the same depths to the bit.
#include "shaders/render/across.hlsli"
#include "shaders/render/ribbon_raster.hlsli"
#include "shaders/render/coverage.hlsli"

RWStructuredBuffer<uint> gNearest : register(u0);
RWStructuredBuffer<uint> gLight : register(u1);

void visitPixel(RibbonPiece piece, int2 pixel) {
    const float2 middle = fromOrigin(piece, pixel);
    const float coverage = lerp(piece.coverage.x, piece.coverage.y, alongPiece(piece, middle));
    const uint mask = sampleMask(gView, coverage, uint2(pixel), piece.strand);
    const uint samples = gRaster.samples;
    const uint base = pixelIndex(pixel) * samples;
    for (uint s = 0; s < samples && (mask >> s) != 0u; ++s) {
        if (((mask >> s) & 1u) == 0u) continue;
        const float2 at = middle + samplePlace(s);
        const float t = placeOn(piece, at);
        const float depth = lerp(piece.depth.x, piece.depth.y, t);
        if (t < 0.0 || depth < 0.0) continue;
        const uint bits = asuint(depth);
        if (gRaster.phase == HAIRLOOM_PHASE_NEAREST) {
            if (bits < gNearest[base + s]) InterlockedMin(gNearest[base + s], bits);
        } else if (bits == gNearest[base + s]) {
            const float3 light = lightOfHair(gView, piece.first, t, placeAcross(piece, at), 0.0);
            InterlockedMax(gLight[base + s], packLight(light));
        }
    }
}
