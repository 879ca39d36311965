// SPDX-License-Identifier: MIT
// Lengths of a strand spread over threads; length.hlsli is the same, point after point. A thread has the segments after
// its points.

/// A row of the tridiagonal system λ = below · λ₋ + above · λ₊ + right: x, y, z; w unused. By the rows before and after
/// it, it is coupled to those twice as far.
float4 reducedRow(float4 own, float4 before, float4 after) {
    const float inverse = 1.0 / (1.0 - own.x * before.y - own.y * after.x);
    return float4(own.x * before.x, own.y * after.y, own.z + own.x * before.z + own.y * after.z, 0) * inverse;
}

/// λ of the last of the thread's rows, by parallel cyclic reduction (Hockney and Jesshope 1981): each step couples rows twice
/// as far apart.
float solveLengths(float4 rows[POINTS_PER_THREAD]) {
    float4 row = rows[POINTS_PER_THREAD - 1];
#if POINTS_PER_THREAD == 2
    // The threads' first rows go out of the system.
    exchangeFirst(rows[0]);
    row = reducedRow(row, rows[0], loadOuter());
#endif
    [unroll] for (uint stride = 1; stride * POINTS_PER_THREAD < HAIR_POINTS - FIRST_FREE; stride *= 2) {
        exchangeLast(row);
        // Beyond the ends rows are not coupled: their factor is 0, and the row that is read any.
        row = reducedRow(row, loadLast(-int(stride)), loadLast(int(stride)));
    }
    return row.z;
}

/// See length.hlsli.
void projectStrand(int holding) {
    float3 starts[POINTS_PER_THREAD], wanted[POINTS_PER_THREAD], acting[POINTS_PER_THREAD];
    float errors[POINTS_PER_THREAD];
    EACH_OWN_POINT(s) starts[s] = holding == PROJECT_DISPLACEMENTS ? gPrevious[s] : startOfSubstep(s);
    exchangeFirst(float4(gPosition[0], 0));
    const float3 after = loadOuter().xyz;
    exchangeFirst(float4(starts[0], 0));
    const float3 startAfter = loadOuter().xyz;
    EACH_OWN_POINT(i) {
        const float3 edge = OUTER_OF(gPosition, i, after) - gPosition[i];
        const float3 edgeBefore = OUTER_OF(starts, i, startAfter) - starts[i];
        wanted[i] = acting[i] = edge * gInverseLength[i];
        errors[i] = 0.5 * (dot(edge, wanted[i]) - gLength[i]);
        if (holding == PROJECT_POSITIONS) {
            const float3 was = edgeBefore * gInverseLength[i];
            if (dot(wanted[i], was) > 0.5 * dot(wanted[i], wanted[i])) acting[i] = was;
        } else if (holding == PROJECT_DISPLACEMENTS) {
            errors[i] = dot(wanted[i], edge - edgeBefore);
        }
    }
    exchange(toFloat4s(acting));
    const float3 actingBefore = loadInner().xyz, actingAfter = loadOuter().xyz;
    Float4s rows;
    EACH_OWN_POINT(j) {
        const float inner = pointOf(j) >= FIRST_FREE ? gInverseMass[j] : 0.0, outer = outerInverseMass(j);
        const float inverse = 1.0 / (max(dot(wanted[j], acting[j]), 0.25) * (inner + outer));
        // The rows of the first and the last segment have one neighbour.
        const float below = dot(wanted[j], INNER_OF(acting, j, actingBefore)) * inner * inverse;
        const float above = pointOf(j) + 2 < POINTS ? dot(wanted[j], OUTER_OF(acting, j, actingAfter)) * outer * inverse : 0.0;
        const bool held = pointOf(j) + 1 >= FIRST_FREE && hasSegment(j);
        rows[j] = held ? float4(below, above, errors[j] * inverse, 0) : float4(0, 0, 0, 0);
    }
    float lambdas[POINTS_PER_THREAD];
    lambdas[POINTS_PER_THREAD - 1] = solveLengths(rows);
    exchangeLast(float4(lambdas[POINTS_PER_THREAD - 1], 0, 0, 0));
    const float lambdaBefore = loadInner().x;
#if POINTS_PER_THREAD == 2
    lambdas[0] = rows[0].x * lambdaBefore + rows[0].y * lambdas[1] + rows[0].z;
#endif
    EACH_OWN_POINT(k) {
        const float3 pullBefore = INNER_OF(acting, k, actingBefore) * INNER_OF(lambdas, k, lambdaBefore);
        const float3 move = (acting[k] * lambdas[k] - pullBefore) * gInverseMass[k];
        if (isFree(k)) {
            if (holding == PROJECT_DISPLACEMENTS) {
                gPrevious[k] -= move;
            } else {
                gPosition[k] += move;
            }
        }
#if HAIR_TENSIONS
        if (holding == PROJECT_POSITIONS && pointOf(k) + 1 >= FIRST_FREE && hasSegment(k))
            keepTension(k, lambdas[k], gLength[k], gInverseMass[k] + outerInverseMass(k));
#endif
    }
}

/// See length.hlsli. From the first segment that is wrong on, each thread goes the way to its own points.
void stageExtension() {
    exchangeLast(float4(gPosition[POINTS_PER_THREAD - 1], gLength[POINTS_PER_THREAD - 1]));
    const float4 before = loadInner();
    bool wrong = false;
    EACH_OWN_POINT(i) {
        const float3 edge = gPosition[i] - INNER_OF(gPosition, i, before.xyz);
        wrong = wrong || (isFree(i) && isWrong(edge, INNER_OF(gLength, i, before.w)));
    }
    if (!anyLane(wrong)) return;
    Float4s positions = toFloat4s(gPosition);
    EACH_OWN_POINT(l) positions[l].w = gLength[l];
    exchange(positions);
    bool moves = false;
    float4 parent = loadPoint(FIRST_FREE - 1);
    [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
        const float4 own = loadPoint(p);
        moves = moves || isWrong(own.xyz - parent.xyz, parent.w);
        parent = float4(withinExtension(parent.xyz, own.xyz, parent.w), own.w);
        EACH_OWN_POINT(k) {
            if (moves && p == pointOf(k)) moveTo(k, parent.xyz);
        }
    }
}
