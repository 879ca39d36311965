// SPDX-License-Identifier: GPL-3.0-or-later
// A point of the curve between two control points (Rünz 2012, Eq. 55 and 56, with the errata's signs), moved by its
// radius to either side.
#include "shaders/render/strand_patch.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
cbuffer Patches : register(b2) { PatchConstants gPatch; };
StructuredBuffer<float4> gColour : register(t1);

struct Output {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float2 coverage : COVERAGE;  // x: of the ribbon by the hair, y: RibbonCorner::depth
#ifndef HAIRLOOM_BLEND
    nointerpolation uint seed : SEED;
#endif
};

[domain("quad")]
Output main(PatchFactors factors, float2 place : SV_DomainLocation,
            const OutputPatch<ControlPoint, POINTS> points) {
    const uint4 patch = points[0].patch;
    const float x = place.x * float(patch.z);
    const uint k = min(uint(x), patch.z - 1u);
    const float t = x - float(k);
    const uint a = k + (patch.w & 1u);
    const float4 pa = points[a].position_ws;
    const float4 pb = points[a + 1u].position_ws;
    const float3 ma = points[a].tangent.xyz;
    const float3 mb = points[a + 1u].tangent.xyz;
    const float t2 = t * t;
    const float t3 = t2 * t;
    CurvePoint p;
    p.position_ws.xyz = (2 * t3 - 3 * t2 + 1) * pa.xyz + (3 * t2 - 2 * t3) * pb.xyz + (t3 - 2 * t2 + t) * ma +
                        (t3 - t2) * mb;
    p.position_ws.w = lerp(pa.w, pb.w, t);
    const float3 tangent = (6 * t2 - 6 * t) * pa.xyz + (6 * t - 6 * t2) * pb.xyz + (3 * t2 - 4 * t + 1) * ma +
                           (3 * t2 - 2 * t) * mb;
    const float speed = length(tangent);
    p.tangentXy = packUnit(speed > 1e-12 ? tangent / speed : normalize(pb.xyz - pa.xyz + float3(0, 1e-12, 0)));
    p.along = 0;
    p.strand = patch.x;
    p.opacity = lerp(points[a].tangent.w, points[a + 1u].tangent.w, t);
    const RibbonCorner corner = ribbonCorner(gView, p, place.y > 0.5);
    // Light was worked out at the points of the strip's curve.
    const float at = x * float(gPatch.subdivisions);
    const uint before = min(uint(at), patch.z * gPatch.subdivisions - 1u);
    Output o;
    o.position = corner.position;
    o.colour = lerp(gColour[patch.y + before].rgb, gColour[patch.y + before + 1u].rgb, at - float(before));
    o.coverage = float2(corner.coverage, corner.depth);
#ifndef HAIRLOOM_BLEND
    o.seed = patch.x;
#endif
    return o;
}
