// SPDX-License-Identifier: MIT
// Angular springs of a strand whose points are lanes; bend.hlsli is the same, point after point.

#if HAIR_TARGETS
/// The normal that the segment before the lane's joint has, walked from the root, and 0 in `known` where the
/// strand folds before it.
float3 walkNormal(float3 inner, float3 tangent, out float known) {
    const float cosine = dot(inner, tangent);
    const float flat = max(1.0 + cosine, 1e-6);
    tell(float4(tangent, cosine < FOLD ? 0.0 : 1.0), float4((inner + tangent) * (1.0 / flat), 0));
    float3 normal = rootNormal();
    known = 1.0;
    [loop] for (uint k = 0; k < gPoint; ++k) {
        const float4 to = told(k);
        normal -= toldToo(k).xyz * dot(to.xyz, normal);
        known = min(known, to.w);
    }
    return normal;
}
#endif

/// The pull of the lane's joint at `position`.
float3 measurePull(bool frames, bool exact) {
    tellPositions();
    const float3 edge = toldOuter().xyz - gPosition, innerEdge = gPosition - toldInner().xyz;
    const float3 tangent = exact ? unitOf(edge) : edge * gInverseLength;
    float3 inner = exact ? unitOf(innerEdge) : innerEdge * gInnerInverseLength;
    if (gPoint == 0) inner = rootTangent();
    float3 off = tangent - inner;
#if HAIR_TARGETS
    if (frames) {
        // Springs may stretch: a frame needs directions of unit length.
        float3 unit = unitOf(innerEdge);
        if (gPoint == 0) unit = inner;
        float known;
        const float3 normal = walkNormal(unit, unitOf(edge), known);
        off -= fromFrame(unit, normal, gTarget);
    }
#endif
    return hasJoint() ? off * gStiff : float3(0, 0, 0);
}

/// Angular springs as forces.
void applyAngular(bool frames, bool exact) {
    const float3 pull = measurePull(frames, exact);
    tell(float4(gPosition, 0), float4(pull, 0));
    const float3 difference = pull - toldTooOuter().xyz;
    float3 outer = difference * gInverseLength;
    if (exact) {
        const float3 edge = toldOuter().xyz - gPosition;
        const float3 tangent = unitOf(edge);
        const float size = max(dot(edge, tangent), gLength * 0.1);
        outer = (difference - tangent * dot(difference, tangent)) * (1.0 / max(size, 1e-9));
    }
    if (!hasSegment()) outer = float3(0, 0, 0);
    tell(float4(outer, 0));
    if (isFree()) gPrevious += (toldInner().xyz - outer) * gInverseMass;
}
#if HAIR_TARGETS
void stageAngularCheap() { applyAngular(true, false); }
void stageAngularExact() { applyAngular(true, true); }
#endif
void stageStraightCheap() { applyAngular(false, false); }
void stageStraightExact() { applyAngular(false, true); }

#if HAIR_BEND == 2
/// Solves (M + (¼ + q) h² K) δ = side by the LDLᵀ factors of the strand: a lane each for x, y and z.
float3 solveBend(float3 side) {
    const uint own = 3 * gLane;
    gSolved[own] = side.x;
    gSolved[own + 1] = side.y;
    gSolved[own + 2] = side.z;
    GroupMemoryBarrierWithGroupSync();
    if (gPoint < 3) {
        const uint first = 3 * gFirst + gPoint;
        float one = 0.0, two = 0.0;
        EACH for (uint p = FIRST_FREE; p < POINTS; ++p) {
            const float4 row = gRows[gFirst + p];
            const float here = gSolved[first + 3 * p] - one * row.y - two * row.z;
            gSolved[first + 3 * p] = here;
            two = one;
            one = here;
        }
        float next = 0.0, second = 0.0, lower1 = 0.0, lower2 = 0.0, lower2Next = 0.0;
        EACH for (int q = int(POINTS) - 1; q >= FIRST_FREE; --q) {
            const float4 row = gRows[gFirst + q];
            const float move = gSolved[first + 3 * q] * row.x - next * lower1 - second * lower2Next;
            gSolved[first + 3 * q] = move;
            second = next;
            next = move;
            lower1 = row.y;
            lower2Next = lower2;
            lower2 = row.z;
        }
    }
    GroupMemoryBarrierWithGroupSync();
    return float3(gSolved[own], gSolved[own + 1], gSolved[own + 2]);
}

#if HAIR_CURVES
/// Turns the curve that the lane's joint holds towards that of its frame at `previous`, as far as the strand's tank
/// lasts.
void followFrames(float3 inner, float3 tangent) {
    float known;
    const float3 normal = walkNormal(inner, tangent, known);
    const float3 held = rotate(gTurn, gCurve);
    float3 change = (fromFrame(inner, normal, gTarget) - held) * known;
    if (!hasJoint()) change = float3(0, 0, 0);
    tell(float4(dot((tangent - inner - held) * gStiff, change), dot(change, change) * gStiff, 0, 0));
    float gain = 0.0, size = 0.0;
    EACH for (uint j = FIRST_FREE - 1; j + 1 < POINTS; ++j) {
        const float2 joint = told(j).xy;
        gain += joint.x;
        size += joint.y;
    }
    const float share = takeShare(gain, size);
    if (hasJoint()) gCurve = held + change * share;
}
#endif

/// Angular springs after position Verlet: see bend.hlsli.
void bendBack() {
    tell(float4(gPosition, 0), float4(gPrevious, 0));
    const float3 edge = toldTooOuter().xyz - gPrevious, innerEdge = gPrevious - toldTooInner().xyz;
    const float3 moved = gPosition - gPrevious;
    const float3 turned = (toldOuter().xyz - toldTooOuter().xyz) - moved;
    const float3 innerTurned = moved - (toldInner().xyz - toldTooInner().xyz);
    const float3 ahead = (edge + turned * gFrame.bendRate) * gInverseLength;
    float3 innerAhead = (innerEdge + innerTurned * gFrame.bendRate) * gInnerInverseLength;
    if (gPoint == 0) innerAhead = rootTangent();
    float3 off = ahead - innerAhead;
#if HAIR_CURVES
    float3 inner = innerEdge * gInnerInverseLength;
    if (gPoint == 0) inner = innerAhead;
    followFrames(inner, edge * gInverseLength);
    off -= gCurve;
#endif
    const float3 pull = hasJoint() ? off * gStiff : float3(0, 0, 0);
#if HAIR_TENSIONS
    tell(float4(pull, gTension));
    float3 side = innerEdge * (-gInnerInverseLength * toldInner().w);
    if (hasSegment()) side += edge * (gInverseLength * gTension);
#else
    tell(float4(pull, 0));
    float3 side = float3(0, 0, 0);
#endif
    side -= (toldInner().xyz - pull) * gInnerInverseLength;
    if (hasSegment()) side += (pull - toldOuter().xyz) * gInverseLength;
    const float3 move = solveBend(side);
    if (isFree()) gPosition += move;
}
void stageAngular() { bendBack(); }
void stageAngularStraight() { bendBack(); }
#endif
