// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles into the samples of a frame, as strand_raster.comp.hlsl does hair.
#include "shaders/render/fragments.hlsli"
#include "shaders/render/skin.hlsli"
#include "shaders/render/triangle_raster.hlsli"

StructuredBuffer<float> gNormals : register(t1);
StructuredBuffer<float> gAlbedo : register(t3);
StructuredBuffer<uint> gCover : register(t4);     // of hair, where that is sorted
RWStructuredBuffer<uint> gNearest : register(u0);
RWStructuredBuffer<uint> gLight : register(u1);

float3 lightAt(Corners c, float2 at, uint face) {
    const float3 shares = sharesOfFace(c, at);
    return skinLight(gMesh, onFace(gPositions, face, shares), onFace(gNormals, face, shares), onFace(gAlbedo, face, shares));
}

void visitPixel(Corners c, int2 pixel, uint face) {
    const float2 middle = float2(pixel - c.origin) + 0.5;
    const uint samples = gRaster.samples;
    const bool sees = gRaster.phase == HAIRLOOM_PHASE_NEAREST || gRaster.sorts == 0u;
    if (!sees && gCover[stepsOf(pixelIndex(pixel))] >= kMostSteps) return;  // hair hides it
    const uint base = pixelIndex(pixel) * samples;
    uint shown = 0;
    float2 place = 0;
    for (uint s = 0; s < samples; ++s) {
        const float2 at = middle + samplePlace(s);
        const float depth = depthAt(c, at);
        if (depth < 0.0 || depth > 1.0) continue;
        const uint bits = asuint(depth);
        if (gRaster.phase == HAIRLOOM_PHASE_NEAREST) {
            if (bits < gNearest[base + s]) InterlockedMin(gNearest[base + s], bits);
        } else if (bits == gNearest[base + s]) {
            if (shown == 0u) place = at;
            shown |= 1u << s;
        }
    }
    if (shown == 0u) return;
    // Once a pixel: in its middle, or where that lies beside the triangle at the first sample that shows.
    const uint light = packLight(lightAt(c, depthAt(c, middle) >= 0.0 ? middle : place, face));
    for (uint k = 0; k < samples; ++k) {
        if (((shown >> k) & 1u) != 0u) InterlockedMax(gLight[base + k], light);
    }
}
