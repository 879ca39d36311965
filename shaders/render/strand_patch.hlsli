// SPDX-License-Identifier: GPL-3.0-or-later
// Tessellated ribbons (Rünz 2012, Section 6.2): a patch is a run of segments of a strand, which stages read from the curve's
// buffer as they need it: 32 control points of their own, as the thesis has them, take a device far longer to pass on.
#include "shaders/render/ribbon.hlsli"

struct ControlPoint {
    nointerpolation uint4 patch : PATCH;  // x: strand, y: curve point of its root, z: first segment, w: segments
    nointerpolation uint points : POINTS;  // of the strand
};

struct PatchFactors {
    float edge[4] : SV_TessFactor;
    float inside[2] : SV_InsideTessFactor;
};

cbuffer Constants : register(b0) { ViewConstants gView; };
cbuffer Patches : register(b2) { PatchConstants gPatch; };
StructuredBuffer<CurvePoint> gCurve : register(t0);

CurvePoint givenPoint(ControlPoint c, uint k) { return gCurve[c.patch.y + k * gPatch.subdivisions]; }

// Of Eq. 56, in world space. Beyond the ends the curve goes on as a mirror image.
float3 tangentAt(ControlPoint c, uint k) {
    const float3 here = givenPoint(c, k).position_ws.xyz;
    const bool first = k == 0u;
    const bool last = k + 1u == c.points;
    const float3 one = givenPoint(c, first ? 1u : k - 1u).position_ws.xyz;
    const float3 before = first ? 2 * here - one : one;
    const float3 other = givenPoint(c, last ? k - 1u : k + 1u).position_ws.xyz;
    const float3 after = last ? 2 * here - other : other;
    return 0.5 * (after - before);
}
