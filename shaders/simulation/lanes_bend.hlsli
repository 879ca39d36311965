// SPDX-License-Identifier: MIT
// Angular springs of a strand whose points are lanes; bend.hlsli is the same, point after point.

#if HAIR_TARGETS
/// The normal that the segment before the lane's joint has, carried from the root; `known` is false where the strand
/// folds before it. A step along the strand takes a normal n to n − a (t·n). Side by side, lanes put the steps of their
/// four lanes together, up to their own; then the normal goes from four to four.
float3 walkNormal(float3 inner, float3 tangent, out bool known) {
    const float cosine = dot(inner, tangent);
    const float flat = max(1.0 + cosine, 1e-6);
    const float3 turn = (inner + tangent) * (1.0 / flat);
    tell(float4(tangent, 0), float4(turn, 0));
    const uint four = gPoint & ~3u;
    // Rows of the map of the steps from the first of the four lanes to this one.
    float3 x = float3(1, 0, 0), y = float3(0, 1, 0), z = float3(0, 0, 1);
    [unroll] for (uint k = 0; k < 3; ++k) {
        const uint step = min(four + k, uint(HAIR_POINTS) - 1);
        const float3 to = told(step).xyz, by = toldToo(step).xyz;
        if (four + k < gPoint) {
            const float3 along = x * to.x + y * to.y + z * to.z;
            x -= along * by.x;
            y -= along * by.y;
            z -= along * by.z;
        }
    }
    float3 start = rootNormal(), normal = start;
    EACH for (uint first = 0; first < HAIR_POINTS; first += 4) {
        const float3 here = float3(dot(x, start), dot(y, start), dot(z, start));
        if (first == four) normal = here;
        if (first + 4 < HAIR_POINTS) {
            tell(float4(here - turn * dot(tangent, here), 0));
            start = told(first + 3).xyz;
        }
    }
    known = firstOfStrand(cosine < FOLD) >= gPoint;
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
        bool known;
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
    const float3 innerPull = toldInner().xyz;
    if (isFree()) gPrevious += (innerPull - outer) * gInverseMass;
}
#if HAIR_TARGETS
void stageAngularCheap() { applyAngular(true, false); }
void stageAngularExact() { applyAngular(true, true); }
#endif
void stageStraightCheap() { applyAngular(false, false); }
void stageStraightExact() { applyAngular(false, true); }

#if HAIR_BEND == 2
/// Solves (M + (¼ + q) h² K) δ = side by cyclic reduction of pairs of points, all of them at a time (as Hockney and
/// Jesshope 1981): each step frees a pair of its neighbours and couples it to those twice as far. Its factors are the
/// strand's own, from the program (core/gpu_simulation/bend_reduction.h); those of points that do not move are 0.
float3 solveBend(float3 side) {
    const uint pair = gPoint & ~1u, last = HAIR_POINTS - 1;
    [unroll] for (uint step = 0; step < BEND_STEPS; ++step) {
        const uint apart = 2u << step;
        // Beyond the ends factors are 0, and the point that is read any.
        const uint before = pair >= apart ? pair - apart : pair;
        const uint after = pair + apart <= last ? pair + apart : pair;
        const float4 by = gReduction[step];
        tell(float4(side, 0));
        side += told(before).xyz * by.x + told(min(before + 1, last)).xyz * by.y + told(after).xyz * by.z +
                told(min(after + 1, last)).xyz * by.w;
    }
    tell(float4(side, 0));
    return side * gReduced.x + told(min(gPoint ^ 1u, last)).xyz * gReduced.y;
}

#if HAIR_CURVES
/// Turns the curve that the lane's joint holds towards that of its frame at `previous`, as far as the strand's tank
/// lasts.
void followFrames(float3 inner, float3 tangent) {
    bool known;
    const float3 normal = walkNormal(inner, tangent, known);
    const float3 held = rotate(turnNow(), gCurve);
    float3 change = fromFrame(inner, normal, gTarget) - held;
    if (!known || !hasJoint()) change = float3(0, 0, 0);
    const float2 joint = float2(dot((tangent - inner - held) * gStiff, change), dot(change, change) * gStiff);
    const float2 sums = sumOfStrand(joint);
    const float share = takeShare(sums.x, sums.y);
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
    const float3 outerPull = (pull - toldOuter().xyz) * gInverseLength;
    if (hasSegment()) side += outerPull;
    gPosition += solveBend(isFree() ? side : float3(0, 0, 0));
}
void stageAngular() { bendBack(); }
void stageAngularStraight() { bendBack(); }
#endif
