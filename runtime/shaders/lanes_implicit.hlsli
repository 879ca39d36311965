// SPDX-License-Identifier: MIT
// Backward Euler of a strand spread over threads; implicit.hlsli is the same, point after point. Coil springs have a
// thread per strand there.
#if HAIR_BEND == 2
void stageImplicitBend() {
    float3 moved[POINTS_PER_THREAD], turnings[POINTS_PER_THREAD], pulls[POINTS_PER_THREAD], sides[POINTS_PER_THREAD];
    EACH_OWN_POINT(m) moved[m] = gPosition[m] - gPrevious[m];
    exchange(toFloat4s(moved));
    const float3 movedBefore = loadInner().xyz, movedAfter = loadOuter().xyz;
    EACH_OWN_POINT(t) turnings[t] = (OUTER_OF(moved, t, movedAfter) - moved[t]) * gInverseLength[t];
    float3 behind = (moved[0] - movedBefore) * gInverseLengthBefore;
    if (gThread == 0) behind = float3(0, 0, 0);
    EACH_OWN_POINT(j) pulls[j] = hasJoint(j) ? (turnings[j] - INNER_OF(turnings, j, behind)) * gStiff[j] : float3(0, 0, 0);
    exchange(toFloat4s(pulls));
    const float3 pullBefore = loadInner().xyz, pullAfter = loadOuter().xyz;
    EACH_OWN_POINT(k) {
        float3 side = (pulls[k] - INNER_OF(pulls, k, pullBefore)) * innerInverseLength(k);
        if (hasSegment(k)) side += (pulls[k] - OUTER_OF(pulls, k, pullAfter)) * gInverseLength[k];
        sides[k] = isFree(k) ? side : float3(0, 0, 0);
    }
    solveBend(sides);
    EACH_OWN_POINT(d) gPosition[d] += sides[d];
    stageImplicitFree();
}
#endif
