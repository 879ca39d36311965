// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/strand_patch.hlsli"

StructuredBuffer<StrandHeader> gStrands : register(t2);
StructuredBuffer<StrandPatch> gPatches : register(t3);

ControlPoint main(uint id : SV_VertexID) {
    const StrandPatch patch = gPatches[gPatch.firstPatch + id];
    ControlPoint o;
    o.patch = uint4(patch.strand, gStrands[patch.strand].segmentsBefore * gPatch.subdivisions + patch.strand,
                    patch.firstSegment, patch.segments);
    o.points = patch.pointCount;
    return o;
}
