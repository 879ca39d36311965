// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/ribbon.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<float4> gColour : register(t1);

struct Output {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float coverage : COVERAGE;
    nointerpolation uint seed : SEED;
};

Output main(uint vertex : SV_VertexID) {
    const CurvePoint p = gCurve[vertex >> 1u];
    const RibbonCorner corner = ribbonCorner(gView, p, (vertex & 1u) != 0);
    Output o;
    o.position = corner.position;
    o.colour = gColour[vertex >> 1u].rgb;
    o.coverage = corner.coverage;
    o.seed = p.strand;
    return o;
}
