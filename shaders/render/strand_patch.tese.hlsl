// SPDX-License-Identifier: GPL-3.0-or-later
// A point of the curve between two given points (Rünz 2012, Eq. 55 and 56, with the errata's signs), moved by its radius to
// either side. A patch that is cut along has two rows across, whatever is asked for; the first of them has no width.
#include "shaders/render/strand_patch.hlsli"

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

[domain("quad")]
Output main(PatchFactors factors, float2 place : SV_DomainLocation, const OutputPatch<ControlPoint, 1> points) {
    const ControlPoint c = points[0];
    const float x = place.x * float(c.patch.w);
    const uint segment = min(uint(x), c.patch.w - 1u);
    const float t = x - float(segment);
    const uint a = c.patch.z + segment;
    const CurvePoint from = givenPoint(c, a);
    const CurvePoint to = givenPoint(c, a + 1u);
    const float3 pa = from.position_ws.xyz;
    const float3 pb = to.position_ws.xyz;
    const float3 ma = tangentAt(c, a);
    const float3 mb = tangentAt(c, a + 1u);
    const float t2 = t * t;
    const float t3 = t2 * t;
    CurvePoint p;
    p.position_ws.xyz =
        (2 * t3 - 3 * t2 + 1) * pa + (3 * t2 - 2 * t3) * pb + (t3 - 2 * t2 + t) * ma + (t3 - t2) * mb;
    p.position_ws.w = lerp(from.position_ws.w, to.position_ws.w, t);
    const float3 tangent =
        (6 * t2 - 6 * t) * pa + (6 * t - 6 * t2) * pb + (3 * t2 - 4 * t + 1) * ma + (3 * t2 - 2 * t) * mb;
    const float speed = length(tangent);
    p.tangentXy = packUnit(speed > 1e-12 ? tangent / speed : normalize(pb - pa + float3(0, 1e-12, 0)));
    p.along = 0;
    p.strand = c.patch.x;
    p.opacity = lerp(from.opacity, to.opacity, t);
    const RibbonCorner corner = ribbonCorner(gView, p, place.y > 0.5);
    // Light was worked out at the points of the strip's curve.
    const float at = t * float(gPatch.subdivisions);
    const uint piece = min(uint(at), gPatch.subdivisions - 1u);
    const uint before = c.patch.y + a * gPatch.subdivisions + piece;
    Output o;
    o.position = corner.position;
    o.colour = lerp(gColour[before].rgb, gColour[before + 1u].rgb, at - float(piece));
    o.coverage = float2(corner.coverage, corner.depth);
#ifndef HAIRLOOM_BLEND
    o.seed = c.patch.x;
#endif
    o.place = float2(float(segment * gPatch.subdivisions) + at, place.y > 0.5 ? 1.0 : -1.0);
    o.pieces = uint2(c.patch.y + c.patch.z * gPatch.subdivisions, c.patch.w * gPatch.subdivisions);
    return o;
}
