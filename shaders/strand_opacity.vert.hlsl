// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/ribbon.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
StructuredBuffer<CurvePoint> gCurve : register(t0);

struct Output {
    float4 position : SV_Position;
    float coverage : COVERAGE;
};

Output main(uint vertex : SV_VertexID) {
    const RibbonCorner corner = ribbonCorner(gView, gCurve[vertex >> 1u], (vertex & 1u) != 0);
    Output o;
    o.position = corner.position;
    o.coverage = corner.coverage;
    return o;
}
