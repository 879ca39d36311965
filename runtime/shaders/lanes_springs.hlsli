// SPDX-License-Identifier: MIT
// Springs of a strand spread over threads; springs.hlsli is the same, point after point.

void stageSprings() {
    exchangePositions();
    const float3 after = loadOuter().xyz;
    float3 outers[POINTS_PER_THREAD];
    EACH_OWN_POINT(i) {
        outers[i] = float3(0, 0, 0);
        if (pointOf(i) + 1 >= FIRST_FREE && hasSegment(i)) {
            const Direction edge = edgeOf(OUTER_OF(gPosition, i, after) - gPosition[i]);
            const float step = 2.0 * gFrame.substep.springStep / (gInverseMass[i] + outerInverseMass(i));
            outers[i] = edge.unit * ((edge.size - gLength[i]) * step);
        }
    }
    exchange(toFloat4s(outers));
    const float3 before = loadInner().xyz;
    FREE_POINTS(k) gPrevious[k] -= (outers[k] - INNER_OF(outers, k, before)) * gInverseMass[k];
}

#if HAIR_BEND
void stageFlexion() {
    exchangePositions();
    const float3 before = loadInner().xyz, after = loadOuter().xyz;
    float3 pulls[POINTS_PER_THREAD];
    EACH_OWN_POINT(i) {
        pulls[i] = float3(0, 0, 0);
        if (pointOf(i) >= 1 && hasSegment(i)) {
            const float3 span = restVector(pointOf(i) - 1) + restVector(pointOf(i));
            const Direction edge = edgeOf(OUTER_OF(gPosition, i, after) - INNER_OF(gPosition, i, before));
            pulls[i] = edge.unit * ((edge.size - sqrt(dot(span, span))) * gStiff[i]);
        }
    }
    exchange(toFloat4s(pulls));
    const float3 pullBefore = loadInner().xyz, pullAfter = loadOuter().xyz;
    FREE_POINTS(k) {
        gPrevious[k] += INNER_OF(pulls, k, pullBefore) * gInverseMass[k];
        if (hasSegment(k)) gPrevious[k] -= OUTER_OF(pulls, k, pullAfter) * gInverseMass[k];
    }
}
#endif

/// Each segment moves both its points, root to tip: each thread goes all the way and keeps its own.
void stageSpringLimit() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) {
        Float4s positions = toFloat4s(gPosition), masses;
        EACH_OWN_POINT(i) {
            positions[i].w = gLength[i];
            masses[i] = float4(gInverseMass[i], 0, 0, 0);
        }
        exchange(positions, masses);
        float3 own[POINTS_PER_THREAD] = gPosition;
        float3 from = loadPoint(FIRST_FREE - 1).xyz;
        float length = loadPoint(FIRST_FREE - 1).w, inner = 0.0;
        [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
            const float4 to = loadPoint(p);
            const float outer = loadPointSecond(p).x;
            const float3 impulse = limitImpulse(to.xyz - from, length, inner + outer);
            EACH_OWN_POINT(k) if (p == pointOf(k) + 1) own[k] = from + impulse * inner;
            from = to.xyz - impulse * outer;
            EACH_OWN_POINT(j) if (p == pointOf(j)) own[j] = from;
            length = to.w;
            inner = outer;
        }
        FREE_POINTS(m) gPosition[m] = own[m];
    }
}
