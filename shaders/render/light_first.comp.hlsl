// SPDX-License-Identifier: GPL-3.0-or-later
// The depth of the first hair that a light meets in each texel of its square, as its bits.
#include "shaders/render/ribbon_raster.hlsli"

RWStructuredBuffer<uint> gFirst : register(u0);

void visitPixel(RibbonPiece piece, int2 pixel) {
    const float t = placeOn(piece, fromOrigin(piece, pixel));
    const float depth = lerp(piece.depth.x, piece.depth.y, t);
    if (t < 0.0 || depth < 0.0) return;
    const uint at = pixelIndex(pixel);
    if (asuint(depth) < gFirst[at]) InterlockedMin(gFirst[at], asuint(depth));
}
