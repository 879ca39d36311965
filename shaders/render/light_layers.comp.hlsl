// SPDX-License-Identifier: GPL-3.0-or-later
// Counts each hair's coverage in the layer that it falls into; a layer holds what lies in it alone. Deep opacity maps
// (Yuksel and Keyser 2008) count depth from the first hair of each texel, opacity shadow maps (Kim and Neumann 2001)
// from where hair begins. Counts are whole numbers: their sum does not depend on the order.
#include "shaders/render/ribbon_raster.hlsli"
#include "shaders/render/opacity.hlsli"

StructuredBuffer<uint> gFirst : register(t2);
RWStructuredBuffer<uint> gCounts : register(u0);  // of one light's square, the layers of a texel side by side

void visitPixel(RibbonPiece piece, int2 pixel) {
    const float t = placeOn(piece, fromOrigin(piece, pixel));
    const float z = lerp(piece.depth.x, piece.depth.y, t);
    if (t < 0.0 || z < 0.0 || z > 1.0) return;
    const uint amount = uint(saturate(lerp(piece.coverage.x, piece.coverage.y, t)) * gView.fibresForEach * FIBRE_COUNT + 0.5);
    const bool fixedLayers = gView.shadows == HAIRLOOM_SHADOWS_OPACITY_MAPS;
    const float begins =
        fixedLayers ? gView.hairBegins : metresBehindNear(gView.depthRange, gView.nearPlane, asfloat(gFirst[pixelIndex(pixel)]));
    const float behind = metresBehindNear(gView.depthRange, gView.nearPlane, z) - begins;
    const uint last = gRaster.layers - 1u;
    uint layer = 0u;
    if (gRaster.layers == (fixedLayers ? 4u : 3u)) {
        layer = (behind >= gView.layers.x ? 1u : 0u) + (behind >= gView.layers.y ? 1u : 0u) +
                (behind >= gView.layers.z ? 1u : 0u);
    } else {
        layer = layerAt(behind / (fixedLayers ? gView.layers.w : gView.layers.z), gRaster.layers, gRaster.layerGrowth);
    }
    const int2 inSquare = pixel - int2(gRaster.window.xy);
    const uint texel = uint(inSquare.y) * uint(gRaster.window.z) + uint(inSquare.x);
    InterlockedAdd(gCounts[texel * (last + 1u) + min(layer, last)], amount);
}
