// SPDX-License-Identifier: GPL-3.0-or-later
// Lists what lies in each texel of a light's square: first how much that is in all, then each piece of hair, linked to what was
// there before it. Lists are as long as a buffer together, and as HAIRLOOM_LISTED_OF_TEXEL each: where hair has more, a random part of it,
// which does not depend on the order of threads, counts as all.
#include "shaders/render/ribbon_raster.hlsli"
#include "shaders/render/adaptive.hlsli"

RWStructuredBuffer<uint> gListed : register(u0);     // two a square: of all, and of those that are linked
RWStructuredBuffer<uint> gBegins : register(u1);     // of the square's texels: number of the piece linked last, from 1; then how many each has
RWStructuredBuffer<uint> gFragments : register(u2);  // HAIRLOOM_LISTED_WORDS each

void visitPixel(RibbonPiece piece, int2 pixel) {
    const float t = placeOn(piece, fromOrigin(piece, pixel));
    const float z = lerp(piece.depth.x, piece.depth.y, t);
    if (t < 0.0 || z < 0.0 || z > 1.0) return;
    const int2 inSquare = pixel - int2(gRaster.window.xy);
    const uint texel = uint(inSquare.y) * uint(gRaster.window.z) + uint(inSquare.x);
    const uint texels = uint(gRaster.window.z) * uint(gRaster.window.w);
    if (gRaster.phase == HAIRLOOM_PHASE_COUNT) {
        InterlockedAdd(gListed[2u * gRaster.square], 1u);
        InterlockedAdd(gBegins[texels + texel], 1u);
        return;
    }
    const float share = min(listedShare(gListed[2u * gRaster.square], gRaster.fragments), listedShareOfTexel(gBegins[texels + texel]));
    if (share < 1.0 && chanceOf(piece.first, texel) >= uint(share * 4294967040.0)) return;
    uint place = 0u;
    InterlockedAdd(gListed[2u * gRaster.square + 1u], 1u, place);
    if (place >= gRaster.fragments) return;
    uint before = 0u;
    InterlockedExchange(gBegins[texel], place + 1u, before);
    const float cover = saturate(lerp(piece.coverage.x, piece.coverage.y, t)) * gView.fibresForEach;
    gFragments[HAIRLOOM_LISTED_WORDS * place] = asuint(z);
    gFragments[HAIRLOOM_LISTED_WORDS * place + 1u] = uint(cover * FIBRE_COUNT / share + 0.5);
    gFragments[HAIRLOOM_LISTED_WORDS * place + 2u] = before;
}
