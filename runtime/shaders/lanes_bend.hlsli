// SPDX-License-Identifier: MIT
// Angular springs of a strand spread over threads; bend.hlsli is the same, point after point.

#if HAIR_TARGETS
/// The normals that the segments before the thread's joints have, carried from the root. A step along the strand takes a normal n to n − a (t·n); in a wave threads hand normals on, else each goes
/// all the way. `inner` is the direction before the thread's first point, `tangents` are those after its points.
void walkNormal(float3 inner, float3 tangents[POINTS_PER_THREAD], out float3 normals[POINTS_PER_THREAD]) {
    float3 turns[POINTS_PER_THREAD];
    EACH_OWN_POINT(i) {
        const float3 before = INNER_OF(tangents, i, inner);
        turns[i] = (before + tangents[i]) * (1.0 / max(1.0 + dot(before, tangents[i]), 1e-6));
    }
#if HAIR_WAVE
    float3 end = rootNormal(), further[POINTS_PER_THREAD];  // behind the thread's points; how it goes on from one before them
    EACH_OWN_POINT(n) {
        end -= turns[n] * dot(tangents[n], end);
        further[n] = gThread == 0 ? float3(0, 0, 0) : turns[n];
    }
    // The first thread's is right, and stays; after each turn another one's is.
    [unroll] for (uint turn = 2; turn < STRAND_THREADS; ++turn) {
        end = WaveReadLaneAt(end, gInner);
        EACH_OWN_POINT(m) end -= further[m] * dot(tangents[m], end);
    }
    const float3 before = WaveReadLaneAt(end, gInner);
    float3 here = gThread == 0 ? rootNormal() : before;
#else
    exchange(toFloat4s(tangents), toFloat4s(turns));
    float3 start = rootNormal(), here = start;
    EACH for (uint thread = 0; thread + 1 < STRAND_THREADS; ++thread) {
        EACH_OWN_POINT(n) {
            const uint p = thread * POINTS_PER_THREAD + n;
            start -= loadPointSecond(p).xyz * dot(loadPoint(p).xyz, start);
        }
        if (thread + 1 == gThread) here = start;
    }
#endif
    EACH_OWN_POINT(k) {
        normals[k] = here;
        here -= turns[k] * dot(tangents[k], here);
    }
}
#endif

/// The pulls of the thread's joints at `position`.
void measurePulls(bool frames, bool exact, out float3 pulls[POINTS_PER_THREAD]) {
    exchangePositions();
    const float3 before = loadInner().xyz, after = loadOuter().xyz;
    float3 tangents[POINTS_PER_THREAD], units[POINTS_PER_THREAD], inners[POINTS_PER_THREAD];
    float3 unitBefore = unitOf(gPosition[0] - before);
    EACH_OWN_POINT(i) {
        const float3 edge = OUTER_OF(gPosition, i, after) - gPosition[i];
        const float3 innerEdge = gPosition[i] - INNER_OF(gPosition, i, before);
        units[i] = unitOf(edge);
        tangents[i] = exact ? units[i] : edge * gInverseLength[i];
        inners[i] = exact ? unitOf(innerEdge) : innerEdge * innerInverseLength(i);
    }
    if (gThread == 0) unitBefore = inners[0] = rootTangent();
    EACH_OWN_POINT(k) pulls[k] = tangents[k] - inners[k];
#if HAIR_TARGETS
    if (frames) {
        // Springs may stretch: a frame needs directions of unit length.
        float3 normals[POINTS_PER_THREAD];
        walkNormal(unitBefore, units, normals);
        EACH_OWN_POINT(f) pulls[f] -= fromFrame(INNER_OF(units, f, unitBefore), normals[f], target(pointOf(f)));
    }
#endif
    EACH_OWN_POINT(j) pulls[j] = hasJoint(j) ? pulls[j] * gStiff[j] : float3(0, 0, 0);
}

/// Angular springs as forces.
void applyAngular(bool frames, bool exact) {
    float3 pulls[POINTS_PER_THREAD], outers[POINTS_PER_THREAD];
    measurePulls(frames, exact, pulls);
    exchange(toFloat4s(gPosition), toFloat4s(pulls));
    const float3 after = loadOuter().xyz, pullAfter = loadOuterSecond().xyz;
    EACH_OWN_POINT(i) {
        const float3 difference = pulls[i] - OUTER_OF(pulls, i, pullAfter);
        outers[i] = difference * gInverseLength[i];
        if (exact) {
            const float3 edge = OUTER_OF(gPosition, i, after) - gPosition[i];
            const float3 tangent = unitOf(edge);
            const float size = max(dot(edge, tangent), gLength[i] * 0.1);
            outers[i] = (difference - tangent * dot(difference, tangent)) * (1.0 / max(size, 1e-9));
        }
        if (!hasSegment(i)) outers[i] = float3(0, 0, 0);
    }
    exchange(toFloat4s(outers));
    const float3 before = loadInner().xyz;
    FREE_POINTS(k) gPrevious[k] += (INNER_OF(outers, k, before) - outers[k]) * gInverseMass[k];
}
#if HAIR_TARGETS
void stageAngularSmallAngle() { applyAngular(true, false); }
void stageAngularExact() { applyAngular(true, true); }
#endif
void stageStraightSmallAngle() { applyAngular(false, false); }
void stageStraightExact() { applyAngular(false, true); }

#if HAIR_BEND == 2
/// Solves (M + (¼ + q) h² K) δ = side by cyclic reduction of pairs of points, all of them at a time (as Hockney and
/// Jesshope 1981): each step frees a pair of its neighbours and couples it to those twice as far. Its factors are the
/// strand's own, from the program (core/gpu_simulation/bend_reduction.h); those of points that do not move are 0. They are read
/// in every substep: kept, they cost registers, and fewer groups run side by side.
void solveBend(inout float3 sides[POINTS_PER_THREAD]) {
    const int first = POINTS_PER_THREAD == 1 ? -int(gThread & 1u) : 0;  // of the pair, from the thread's own
    [unroll] for (uint step = 0; step < BEND_STEPS; ++step) {
        const int apart = int(2u << step);
        exchange(toFloat4s(sides));
        // Beyond the ends factors are 0, and the point that is read any.
        const float3 a = loadNeighbour(first - apart).xyz, b = loadNeighbour(first - apart + 1).xyz;
        const float3 c = loadNeighbour(first + apart).xyz, d = loadNeighbour(first + apart + 1).xyz;
        EACH_OWN_POINT(i) {
            const float4 by = gFactors[slotOf(step, pointOf(i))];
            sides[i] += a * by.x + b * by.y + c * by.z + d * by.w;
        }
    }
    float2 reduced[POINTS_PER_THREAD];
    EACH_OWN_POINT(r) reduced[r] = gFactors[slotOf(BEND_STEPS, pointOf(r))].xy;
#if POINTS_PER_THREAD == 1
    exchange(toFloat4s(sides));
    sides[0] = sides[0] * reduced[0].x + loadNeighbour(first == 0 ? 1 : -1).xyz * reduced[0].y;
#else
    const float3 even = sides[0], odd = sides[1];
    sides[0] = even * reduced[0].x + odd * reduced[0].y;
    sides[1] = odd * reduced[1].x + even * reduced[1].y;
#endif
}


/// Angular springs after position Verlet: see bend.hlsli.
void bendBack(bool frames) {
    exchange(toFloat4s(gPrevious));
    const float3 before = loadInner().xyz, after = loadOuter().xyz;
    float3 tangents[POINTS_PER_THREAD], moved[POINTS_PER_THREAD], aheads[POINTS_PER_THREAD], pulls[POINTS_PER_THREAD], sides[POINTS_PER_THREAD];
    EACH_OWN_POINT(i) tangents[i] = (OUTER_OF(gPrevious, i, after) - gPrevious[i]) * gInverseLength[i];
    float3 inner = (gPrevious[0] - before) * gInverseLengthBefore;
    if (gThread == 0) inner = rootTangent();
#if HAIR_TARGETS
    float3 normals[POINTS_PER_THREAD];
    if (frames) walkNormal(inner, tangents, normals);
#endif
    // Where the segments will point. Told after the frames, for which the registers are wanted.
    EACH_OWN_POINT(d) moved[d] = gPosition[d] - gPrevious[d];
    exchange(toFloat4s(moved));
    const float3 movedBefore = loadInner().xyz, movedAfter = loadOuter().xyz;
    EACH_OWN_POINT(a) {
        const float3 turned = OUTER_OF(moved, a, movedAfter) - moved[a];
        aheads[a] = tangents[a] + turned * (gInverseLength[a] * gFrame.substep.bendRate);
    }
    float3 innerAhead = inner;
    if (gThread != 0) innerAhead += (moved[0] - movedBefore) * (gInverseLengthBefore * gFrame.substep.bendRate);
    EACH_OWN_POINT(j) {
        pulls[j] = aheads[j] - INNER_OF(aheads, j, innerAhead);
#if HAIR_TARGETS
        if (frames) pulls[j] -= fromFrame(INNER_OF(tangents, j, inner), normals[j], target(pointOf(j)));
#endif
        pulls[j] = hasJoint(j) ? pulls[j] * gStiff[j] : float3(0, 0, 0);
    }
    Float4s all = toFloat4s(pulls);
#if HAIR_TENSIONS
    EACH_OWN_POINT(t) all[t].w = gTension[t];
#endif
    exchange(all);
    const float4 allBefore = loadInner(), allAfter = loadOuter();
    EACH_OWN_POINT(k) {
        const float4 innerAll = INNER_OF(all, k, allBefore), outerAll = OUTER_OF(all, k, allAfter);
        float3 outer = (pulls[k] - outerAll.xyz) * gInverseLength[k];
        float3 side = (pulls[k] - innerAll.xyz) * innerInverseLength(k);
#if HAIR_TENSIONS
        outer += tangents[k] * all[k].w;
        side -= INNER_OF(tangents, k, inner) * innerAll.w;
#endif
        if (hasSegment(k)) side += outer;
        sides[k] = isFree(k) ? side : float3(0, 0, 0);
    }
    solveBend(sides);
    EACH_OWN_POINT(m) gPosition[m] += sides[m];
}
#if HAIR_TARGETS
void stageAngular() { bendBack(true); }
#endif
void stageAngularStraight() { bendBack(false); }
#endif
