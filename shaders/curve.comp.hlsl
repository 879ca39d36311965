// SPDX-License-Identifier: GPL-3.0-or-later
// From the given points to a finer Catmull-Rom curve with tangents: one thread a strand.
#include "shaders/curve.hlsli"

cbuffer Constants : register(b0) { CurveConstants gCurve; };
StructuredBuffer<StrandHeader> gStrands : register(t0);
StructuredBuffer<float4> gPoints : register(t1);  // w: radius
RWStructuredBuffer<CurvePoint> gResult : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gCurve.strandCount) return;
    const StrandHeader strand = gStrands[id.x];
    const uint segments = strand.pointCount - 1;
    const uint last = segments * gCurve.subdivisions;
    float3 tangent = float3(0, 1, 0);
    for (uint i = 0; i <= last; ++i) {
        const uint k = min(i / gCurve.subdivisions, segments - 1);
        const float t = float(i - k * gCurve.subdivisions) / float(gCurve.subdivisions);
        const float4 p1 = gPoints[strand.firstPoint + k];
        const float4 p2 = gPoints[strand.firstPoint + k + 1];
        // Beyond the ends the curve goes on as a mirror image.
        const float3 p0 = k > 0 ? gPoints[strand.firstPoint + k - 1].xyz : 2 * p1.xyz - p2.xyz;
        const float3 p3 = k + 2 < strand.pointCount ? gPoints[strand.firstPoint + k + 2].xyz : 2 * p2.xyz - p1.xyz;
        const float3 a = p2.xyz - p0;
        const float3 b = 2 * p0 - 5 * p1.xyz + 4 * p2.xyz - p3;
        const float3 c = -p0 + 3 * p1.xyz - 3 * p2.xyz + p3;
        const float3 position = p1.xyz + 0.5 * t * (a + t * (b + t * c));
        const float3 derivative = 0.5 * (a + t * (2 * b + 3 * t * c));
        const float speed = length(derivative);
        if (speed > 1e-12) tangent = derivative / speed;
        CurvePoint result;
        result.position_ws = float4(position, lerp(p1.w, p2.w, t));
        result.tangentXy = packUnit(tangent);
        result.along = float(i) / float(last);
        result.strand = id.x;
        result.unused = 0;
        gResult[strand.firstCurvePoint + i] = result;
    }
}
