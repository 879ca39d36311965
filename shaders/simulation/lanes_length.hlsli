// SPDX-License-Identifier: MIT
// Lengths of a strand whose points are lanes; length.hlsli is the same, point after point. A lane has the segment
// after its point.

/// λ of the tridiagonal system λ = below · λ₋ + above · λ₊ + right, a row in each lane, by parallel cyclic
/// reduction (Hockney and Jesshope 1981): each step couples rows twice as far apart.
float solveLengths(float below, float above, float right) {
    [unroll] for (uint stride = 1; stride < HAIR_POINTS - FIRST_FREE; stride *= 2) {
        tell(float4(below, above, right, 0));
        // Beyond the ends rows are not coupled: their factor is 0, and the row that is read any.
        const float3 before = told(gPoint >= stride ? gPoint - stride : gPoint).xyz;
        const float3 after = told(min(gPoint + stride, uint(HAIR_POINTS) - 1)).xyz;
        const float inverse = 1.0 / (1.0 - below * before.y - above * after.x);
        right = (right + below * before.z + above * after.z) * inverse;
        below *= before.x * inverse;
        above *= after.y * inverse;
    }
    return right;
}

/// See length.hlsli.
void holdStrand(int holding) {
    tell(float4(gPosition, 0), float4(holding == HOLD_RATES ? gPrevious : startOfSubstep(gPoint), 0));
    const float3 edge = toldOuter().xyz - gPosition;
    const float3 wanted = edge * gInverseLength;
    float3 acting = wanted;
    float error = 0.5 * (dot(edge, wanted) - gLength);
    if (holding == HOLD_PLACES) {
        const float3 before = (toldTooOuter().xyz - startOfSubstep(gPoint)) * gInverseLength;
        if (dot(wanted, before) > 0.5 * dot(wanted, wanted)) acting = before;
    } else if (holding == HOLD_RATES) {
        error = dot(wanted, edge - (toldTooOuter().xyz - gPrevious));
    }
    const bool held = gPoint + 1 >= FIRST_FREE && hasSegment();
    tell(float4(acting, 0));
    const float inner = gPoint >= FIRST_FREE ? gInverseMass : 0.0, outer = gOuterInverseMass;
    const float inverse = 1.0 / (max(dot(wanted, acting), 0.25) * (inner + outer));
    // The rows of the first and the last segment have one neighbour.
    float below = dot(wanted, toldInner().xyz) * inner * inverse;
    float above = gPoint + 2 < POINTS ? dot(wanted, toldOuter().xyz) * outer * inverse : 0.0;
    error *= inverse;
    if (!held) below = above = error = 0.0;
    const float lambda = solveLengths(below, above, error);
    const float3 pull = held ? acting * lambda : float3(0, 0, 0);
    tell(float4(pull, 0));
    const float3 move = (pull - toldInner().xyz) * gInverseMass;
    if (isFree()) {
        if (holding == HOLD_RATES) {
            gPrevious -= move;
        } else {
            gPosition += move;
        }
    }
#if HAIR_TENSIONS
    if (holding == HOLD_PLACES && held) keepTension(gPoint, lambda, gLength, gInverseMass + gOuterInverseMass);
#endif
}

/// See length.hlsli. From the first segment that is wrong on, each lane goes the way to its own point.
void stageExtension() {
    tell(float4(gPosition, gLength));
    const float4 inner = toldInner();
    const uint begin = firstOfStrand(isFree() && isWrong(gPosition - inner.xyz, inner.w));
    if (begin <= gPoint && gPoint < POINTS) {
        float4 parent = told(begin - 1);
        [loop] for (uint p = begin; p <= gPoint; ++p) {
            const float4 own = told(p);
            parent = float4(withinExtension(parent.xyz, own.xyz, parent.w), own.w);
        }
        takePlace(gPoint, parent.xyz);
    }
}
