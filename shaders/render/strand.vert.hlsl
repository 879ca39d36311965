// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/ribbon.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<float4> gColour : register(t1);

struct Output {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float2 coverage : COVERAGE;  // x: of the ribbon by the hair, y: RibbonCorner::depth
#ifndef HAIRLOOM_BLEND
    nointerpolation uint seed : SEED;
#endif
    float2 place : PLACE;  // of lightOn()
    nointerpolation uint2 pieces : PIECES;
};

Output main(uint vertex : SV_VertexID) {
    const CurvePoint p = gCurve[vertex >> 1u];
    const RibbonCorner corner = ribbonCorner(gView, p, (vertex & 1u) != 0);
    Output o;
    o.position = corner.position;
    o.colour = gColour[vertex >> 1u].rgb;
    o.coverage = float2(corner.coverage, corner.depth);
#ifndef HAIRLOOM_BLEND
    o.seed = p.strand;
#endif
    o.place = float2(float((vertex >> 1u) & 1u), (vertex & 1u) != 0 ? 1.0 : -1.0);
    o.pieces = uint2(vertex >> 1u, 1u);
    return o;
}
