// SPDX-License-Identifier: GPL-3.0-or-later
// A ribbon turned to the eye: vertex 2k lies on one side of curve point k, 2k + 1 on the other.
#include "shaders/curve.hlsli"

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
    const float3 centre_ws = p.position_ws.xyz;
    const float3 toEye = gView.eye_ws.xyz - centre_ws * gView.eye_ws.w;
    const float3 across = cross(unpackUnit(p.tangentXy), toEye);
    const float3 side = across * rsqrt(max(dot(across, across), 1e-20));
    const float pixelSize = gView.pixel.x * (gView.eye_ws.w > 0 ? length(toEye) : 1.0);
    const float leastRadius = 0.5 * gView.pixel.y * pixelSize;
    const float radius = max(p.position_ws.w, leastRadius);
    Output o;
    o.position = mul(gView.clipFromWorld, float4(centre_ws + side * ((vertex & 1u) ? radius : -radius), 1));
    o.colour = gView.sampling.z == 0 ? gColour[vertex >> 1u].rgb : float3(0, 0, 0);
    // A hair thinner than the least width keeps its share of light by being as transparent as it is too wide.
    o.coverage = p.position_ws.w / radius;
    o.seed = p.strand;
    return o;
}
