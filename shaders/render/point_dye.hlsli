// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the dye a place of a strand has: the strand's share, and where hair was painted that of its points.
#ifndef HAIRLOOM_POINT_DYE_HLSLI
#define HAIRLOOM_POINT_DYE_HLSLI
#include "shaders/render/look.hlsli"

StructuredBuffer<float> gPointDyes : register(t2);  // one a given point; one in all where none was painted

float dyeAt(StrandHeader strand, float along) {
    if (strand.hasPointDyes == 0u) return strand.dye;
    const uint last = strand.pointCount - 1u;
    const float place = saturate(along) * float(last);
    const uint before = min(uint(place), last - 1u);
    const uint first = strand.firstPoint + before;
    return strand.dye * lerp(gPointDyes[first], gPointDyes[first + 1u], place - float(before));
}

StrandPlace placeOf(StrandHeader strand, float along) {
    StrandPlace p;
    p.along = along;
    p.random = hashUnit(strand.source * 2u + 9u);
    p.streak = strand.streak;
    p.dye = dyeAt(strand, along);
    p.pigment = strand.pigment;
    p.length = strand.length;
    p.own = strand.albedo;
    return p;
}
#endif
