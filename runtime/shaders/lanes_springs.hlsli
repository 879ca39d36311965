// SPDX-License-Identifier: MIT
// Springs of a strand spread over threads; springs.hlsli is the same, point after point.

void stageSprings() {
    tellPositions();
    const float3 after = toldOuter().xyz;
    float3 outers[OWN];
    EACH_OWN(i) {
        outers[i] = float3(0, 0, 0);
        if (pointOf(i) + 1 >= FIRST_FREE && hasSegment(i)) {
            const Direction edge = edgeOf(OUTER_OF(gPosition, i, after) - gPosition[i]);
            const float step = 2.0 * gFrame.springStep / (gInverseMass[i] + outerInverseMass(i));
            outers[i] = edge.unit * ((edge.size - gLength[i]) * step);
        }
    }
    tell(quadsOf(outers));
    const float3 before = toldInner().xyz;
    FREE_POINTS(k) gPrevious[k] -= (outers[k] - INNER_OF(outers, k, before)) * gInverseMass[k];
}

#if HAIR_BEND
void stageFlexion() {
    tellPositions();
    const float3 before = toldInner().xyz, after = toldOuter().xyz;
    float3 pulls[OWN];
    EACH_OWN(i) {
        pulls[i] = float3(0, 0, 0);
        if (pointOf(i) >= 1 && hasSegment(i)) {
            const float3 span = restVector(pointOf(i) - 1) + restVector(pointOf(i));
            const Direction edge = edgeOf(OUTER_OF(gPosition, i, after) - INNER_OF(gPosition, i, before));
            pulls[i] = edge.unit * ((edge.size - sqrt(dot(span, span))) * gStiff[i]);
        }
    }
    tell(quadsOf(pulls));
    const float3 pullBefore = toldInner().xyz, pullAfter = toldOuter().xyz;
    FREE_POINTS(k) {
        gPrevious[k] += INNER_OF(pulls, k, pullBefore) * gInverseMass[k];
        if (hasSegment(k)) gPrevious[k] -= OUTER_OF(pulls, k, pullAfter) * gInverseMass[k];
    }
}
#endif

/// Each segment moves both its points, root to tip: each thread goes all the way and keeps its own.
void stageSpringLimit() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) {
        Quads places = quadsOf(gPosition), masses;
        EACH_OWN(i) {
            places[i].w = gLength[i];
            masses[i] = float4(gInverseMass[i], 0, 0, 0);
        }
        tell(places, masses);
        float3 own[OWN] = gPosition;
        float3 from = told(FIRST_FREE - 1).xyz;
        float length = told(FIRST_FREE - 1).w, inner = 0.0;
        [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
            const float4 to = told(p);
            const float outer = toldToo(p).x;
            const float3 impulse = limitImpulse(to.xyz - from, length, inner + outer);
            EACH_OWN(k) if (p == pointOf(k) + 1) own[k] = from + impulse * inner;
            from = to.xyz - impulse * outer;
            EACH_OWN(j) if (p == pointOf(j)) own[j] = from;
            length = to.w;
            inner = outer;
        }
        FREE_POINTS(m) gPosition[m] = own[m];
    }
}
