// SPDX-License-Identifier: GPL-3.0-or-later
// From the given points to a finer Catmull-Rom curve with tangents: one thread a strand.
#include "shaders/render/curve.hlsli"

cbuffer Constants : register(b0) { CurveConstants gCurve; };
StructuredBuffer<StrandHeader> gStrands : register(t0);
StructuredBuffer<float> gPositions : register(t1);
StructuredBuffer<float> gRadii : register(t2);
RWStructuredBuffer<CurvePoint> gResult : register(u0);

float3 pointOf(StrandHeader strand, uint k) {
    const uint at = (gCurve.firstPoint + strand.firstPoint + k) * gCurve.floatsPerPoint;
    return float3(gPositions[at], gPositions[at + 1u], gPositions[at + 2u]);
}

// Strands beyond the share that is drawn have no width; those near it fade (render::HairDetail).
float levelWidth(uint strand) {
    const float rank = (float(strand) + 0.5) * gCurve.strandShare;
    return gCurve.widening * saturate((gCurve.goneShare - rank) / (gCurve.goneShare - gCurve.fullShare));
}

float radiusOf(StrandHeader strand, uint k, float along) {
    if (gCurve.hasRadii > 0) return gRadii[strand.firstPoint + k];
    return gCurve.rootRadius * (1.0 + (gCurve.tipScale - 1.0) * along * along);
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gCurve.strandCount) return;
    const StrandHeader strand = gStrands[id.x];
    const uint segments = strand.pointCount - 1;
    const uint last = segments * gCurve.subdivisions;
    const float width = levelWidth(id.x) * (1.0 + gCurve.radiusVariation * (2.0 * hashUnit(strand.source * 2u + 7u) - 1.0));
    const uint first = strand.segmentsBefore * gCurve.subdivisions + id.x;
    float3 tangent = float3(0, 1, 0);
    // The control points around segment k. Beyond the ends the curve goes on as a mirror image.
    float3 p1 = pointOf(strand, 0);
    float3 p2 = pointOf(strand, 1);
    float3 p0 = 2 * p1 - p2;
    for (uint k = 0; k < segments; ++k) {
        const float3 p3 = k + 2 < strand.pointCount ? pointOf(strand, k + 2) : 2 * p2 - p1;
        const float r1 = radiusOf(strand, k, float(k) / float(segments));
        const float r2 = radiusOf(strand, k + 1, float(k + 1) / float(segments));
        const float3 a = p2 - p0;
        const float3 b = 2 * p0 - 5 * p1 + 4 * p2 - p3;
        const float3 c = -p0 + 3 * p1 - 3 * p2 + p3;
        const uint steps = gCurve.subdivisions + (k + 1 == segments ? 1u : 0u);
        for (uint s = 0; s < steps; ++s) {
            const float t = float(s) / float(gCurve.subdivisions);
            const float3 position = p1 + 0.5 * t * (a + t * (b + t * c));
            const float3 derivative = 0.5 * (a + t * (2 * b + 3 * t * c));
            const float speed = length(derivative);
            if (speed > 1e-12) tangent = derivative / speed;
            const uint i = k * gCurve.subdivisions + s;
            CurvePoint result;
            result.position_ws = float4(position, lerp(r1, r2, t) * width);
            result.tangentXy = packUnit(tangent);
            result.along = float(i) / float(last);
            result.strand = id.x;
            result.opacity = lerp(gCurve.rootOpacity, gCurve.tipOpacity, result.along);
            gResult[first + i] = result;
        }
        p0 = p1;
        p1 = p2;
        p2 = p3;
    }
}
