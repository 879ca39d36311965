// SPDX-License-Identifier: MIT
// Springs of a strand whose points are lanes; springs.hlsli is the same, point after point.

void stageSprings() {
    tellPositions();
    float3 outer = float3(0, 0, 0);
    if (gPoint + 1 >= FIRST_FREE && hasSegment()) {
        const Direction edge = edgeOf(toldOuter().xyz - gPosition);
        const float step = 2.0 * gFrame.springStep / (gInverseMass + gOuterInverseMass);
        outer = edge.unit * ((edge.size - gLength) * step);
    }
    tell(float4(outer, 0));
    if (isFree()) gPrevious -= (outer - toldInner().xyz) * gInverseMass;
}

#if HAIR_BEND
void stageFlexion() {
    tell(float4(gPosition, 0));
    float3 pull = float3(0, 0, 0);
    if (gPoint >= 1 && hasSegment()) {
        const float3 span = restVector(gPoint - 1) + restVector(gPoint);
        const Direction edge = edgeOf(toldOuter().xyz - toldInner().xyz);
        pull = edge.unit * ((edge.size - sqrt(dot(span, span))) * gStiff);
    }
    tell(float4(pull, 0));
    if (isFree()) {
        gPrevious += toldInner().xyz * gInverseMass;
        if (hasSegment()) gPrevious -= toldOuter().xyz * gInverseMass;
    }
}
#endif

/// Each segment moves both its points, root to tip: each lane goes the way to the segment after its point.
void stageSpringLimit() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) {
        tell(float4(gPosition, gLength), float4(gInverseMass, 0, 0, 0));
        float3 from = told(FIRST_FREE - 1).xyz, own = gPosition;
        const uint last = min(gPoint + 1, uint(POINTS) - 1);
        [loop] for (uint p = FIRST_FREE; p <= last; ++p) {
            const float3 to = told(p).xyz;
            const float outer = toldToo(p).x, inner = p > FIRST_FREE ? toldToo(p - 1).x : 0.0;
            const float3 impulse = limitImpulse(to - from, told(p - 1).w, inner + outer);
            if (p == gPoint + 1) own = from + impulse * inner;
            from = to - impulse * outer;
            if (p == gPoint) own = from;
        }
        if (isFree()) gPosition = own;
    }
}
