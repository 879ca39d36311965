// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the sky and of the head the points of strands see. Neither lights nor the camera change it.
#include "shaders/render/curve.hlsli"
#include "shaders/render/sky_maps.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
RWStructuredBuffer<SkyPoint> gSeen : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gShade.count) return;
    const StrandHeader strand = gStrands[id.x];
    const uint curve = strand.segmentsBefore * gShade.subdivisions + id.x;
    for (uint i = id.y; i < strand.pointCount; i += HAIRLOOM_SKY_THREADS_OF_STRAND) {
        const CurvePoint p = gCurve[curve + i * gShade.subdivisions];
        gSeen[strand.segmentsBefore + id.x + i] =
            skySeen(p.position_ws.xyz, unpackUnit(p.tangentXy), p.position_ws.w * gShade.ownWidth);
    }
}
