// SPDX-License-Identifier: MIT
// Springs of a strand whose points are lanes; springs.hlsli is the same, point after point.

void stageSprings() {
    tellPositions();
    const float3 way = toldOuter().xyz - gPosition;
    float3 outer = float3(0, 0, 0);
    if (gPoint + 1 >= FIRST_FREE && hasSegment()) {
        const Direction edge = edgeOf(way);
        const float step = 2.0 * gFrame.springStep / (gInverseMass + gOuterInverseMass);
        outer = edge.unit * ((edge.size - gLength) * step);
    }
    tell(float4(outer, 0));
    const float3 inner = toldInner().xyz;
    if (isFree()) gPrevious -= (outer - inner) * gInverseMass;
}

#if HAIR_BEND
void stageFlexion() {
    tell(float4(gPosition, 0));
    const float3 way = toldOuter().xyz - toldInner().xyz;
    float3 pull = float3(0, 0, 0);
    if (gPoint >= 1 && hasSegment()) {
        const float3 span = restVector(gPoint - 1) + restVector(gPoint);
        const Direction edge = edgeOf(way);
        pull = edge.unit * ((edge.size - sqrt(dot(span, span))) * gStiff);
    }
    tell(float4(pull, 0));
    const float3 inner = toldInner().xyz, outer = toldOuter().xyz;
    if (isFree()) {
        gPrevious += inner * gInverseMass;
        if (hasSegment()) gPrevious -= outer * gInverseMass;
    }
}
#endif

/// Each segment moves both its points, root to tip: each lane goes all the way and keeps its own.
void stageSpringLimit() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) {
        tell(float4(gPosition, gLength), float4(gInverseMass, 0, 0, 0));
        float3 from = told(FIRST_FREE - 1).xyz, own = gPosition;
        float length = told(FIRST_FREE - 1).w, inner = 0.0;
        [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
            const float4 to = told(p);
            const float outer = toldToo(p).x;
            const float3 impulse = limitImpulse(to.xyz - from, length, inner + outer);
            if (p == gPoint + 1) own = from + impulse * inner;
            from = to.xyz - impulse * outer;
            if (p == gPoint) own = from;
            length = to.w;
            inner = outer;
        }
        if (isFree()) gPosition = own;
    }
}
