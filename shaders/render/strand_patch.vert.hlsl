// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/strand_patch.hlsli"

cbuffer Patches : register(b2) { PatchConstants gPatch; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t2);
StructuredBuffer<StrandPatch> gPatches : register(t3);

ControlPoint main(uint id : SV_VertexID) {
    const StrandPatch patch = gPatches[gPatch.firstPatch + id / POINTS];
    const uint k = min(id % POINTS, patch.pointCount - 1u);
    const uint subdivisions = gPatch.subdivisions;
    const uint root = gStrands[patch.strand].segmentsBefore * subdivisions + patch.strand;
    const uint skipped = patch.firstPoint > 0u ? 1u : 0u;
    ControlPoint o;
    const CurvePoint p = gCurve[root + (patch.firstPoint + k) * subdivisions];
    o.position_ws = p.position_ws;
    o.tangent = float4(0, 0, 0, p.opacity);
    o.patch = uint4(patch.strand, root + (patch.firstPoint + skipped) * subdivisions, patch.segments,
                    skipped | (patch.pointCount << 8u));
    return o;
}
