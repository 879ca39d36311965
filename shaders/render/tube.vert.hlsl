// SPDX-License-Identifier: GPL-3.0-or-later
// A ribbon that shows a round strand: the pixel shader finds the place on its surface.
#include "shaders/render/ribbon.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<float4> gColour : register(t1);

struct Output {
    float4 position : SV_Position;
    float3 albedo : COLOR;
    float4 centre_ws : POSITION;  // w: radius
    float3 side_ws : SIDE;
    float3 front_ws : FRONT;
    float across : ACROSS;  // -1 ... 1 from one edge to the other
};

Output main(uint vertex : SV_VertexID) {
    const CurvePoint p = gCurve[vertex >> 1u];
    const bool second = (vertex & 1u) != 0;
    const float3 tangent = unpackUnit(p.tangentXy);
    const float3 toEye = gView.eye_ws.xyz - p.position_ws.xyz * gView.eye_ws.w;
    const float3 across = cross(tangent, toEye);
    Output o;
    o.position = ribbonCorner(gView, p, second).position;
    o.albedo = gColour[vertex >> 1u].rgb;
    o.centre_ws = p.position_ws;
    o.side_ws = across * rsqrt(max(dot(across, across), 1e-20));
    o.front_ws = cross(o.side_ws, tangent);
    o.across = second ? 1.0 : -1.0;
    return o;
}
