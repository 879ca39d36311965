// SPDX-License-Identifier: MIT
// Backward Euler (Rünz 2012, Eq. 9; docs/engine.md): a direct solve along each strand, which a thread does alone. A step is
// of displacements d, in which forces have left u + h² f/M: (M + h² K) d = M (u + h² f/M) for what is stiff.
#if HAIR_EVALUATION == 1 || HAIR_EVALUATION == 3

/// Closes the step: the displacement is what the forces and the solve have left, that of clamped points their own.
void stageImplicitFree() {
    ALL_POINTS(p) {
        const float3 from = start(p);
        const float3 moving = pointOf(p) < FIRST_FREE ? stepDisplacement(p) : position(p) - previous(p);
        setPosition(p, from + moving);
        setPrevious(p, from);
    }
}

#if HAIR_STORAGE == 3
#include "lanes_implicit.hlsli"
#else
#if HAIR_BEND == 2
/// With angular springs: d = u + h² f/M + δ, where (M + h² K) δ = −h² K (u + h² f/M).
void stageImplicitBend() {
    float3 from = position(0) - previous(0), behind = float3(0, 0, 0);
    EACH for (uint j = 0; j + 1 < POINTS; ++j) {
        const float3 to = position(j + 1) - previous(j + 1);
        const float3 turning = (to - from) * inverseLength(j);
        setWork(j, (turning - behind) * stiffness(j));
        from = to;
        behind = turning;
    }
    setWork(POINTS - 1, float3(0, 0, 0));
    solveBend();
    stageImplicitFree();
}
#endif

#if HAIR_EVALUATION == 3
/// A symmetric matrix: xx, xy, xz and yy, yz, zz.
struct Symmetric {
    float3 first, rest;
};
float3 times(Symmetric m, float3 v) {
    return float3(dot(m.first, v), m.first.y * v.x + m.rest.x * v.y + m.rest.y * v.z,
                  m.first.z * v.x + m.rest.y * v.y + m.rest.z * v.z);
}

/// Of a positive definite matrix, by LDLᵀ: cofactors would lose what is soft beside what is stiff. What rounding makes of
/// the softest stays positive.
Symmetric inverseOfMatrix(Symmetric m) {
    const float first = 1.0 / m.first.x;
    const float xy = m.first.y * first, xz = m.first.z * first;
    const float second = 1.0 / max(m.rest.x - xy * m.first.y, m.rest.x * 1e-7);
    const float left = m.rest.y - xy * m.first.z;
    const float yz = left * second;
    const float third = 1.0 / max(m.rest.z - xz * m.first.z - yz * left, m.rest.z * 1e-7);
    // The last rows of the inverse of L.
    const float b = xy * yz - xz;
    Symmetric inverse;
    inverse.first = float3(first + xy * xy * second + b * b * third, -xy * second - b * yz * third, b * third);
    inverse.rest = float3(second + yz * yz * third, -yz * third, third);
    return inverse;
}

/// h² times the Jacobian of the coil spring of segment s. Its compressive part, which would make the matrix indefinite, is
/// left out (as Choi and Ko 2002).
Symmetric coilJacobian(uint s) {
    const Direction edge = edgeOf(start(s + 1) - start(s));
    const float step = 2.0 * gFrame.substep.springStep / (inverseMass(s) + inverseMass(s + 1));
    const float across = step * max(1.0 - segmentLength(s) / max(edge.size, 1e-10), 0.0);
    const float3 d = edge.unit, along = d * (step - across);
    Symmetric jacobian;
    jacobian.first = float3(across + along.x * d.x, along.x * d.y, along.x * d.z);
    jacobian.rest = float3(across + along.y * d.y, along.y * d.z, across + along.z * d.z);
    return jacobian;
}

// The compiler evaluates both sides of a choice: what may be out of range is read under an if.

/// h² K of the angular springs between point p and the one two before; 0 without.
float bendCoupling(uint p) {
    float coupling = 0.0;
#if HAIR_BEND == 1
    if (p > 1 && p < POINTS) coupling = stiffness(p - 1) * inverseLength(p - 1) * inverseLength(p - 2);
#endif
    return coupling;
}

/// Of the row of point p: its own entry, to the point before and to the one before that.
float3 bendRow(uint p) {
#if HAIR_BEND == 1
    const float outerBefore = inverseLength(p - 1);
    float innerBefore = 0.0;
    if (p > 1) innerBefore = inverseLength(p - 2);
    const float before = stiffness(p - 1) * outerBefore;
    float3 row = float3(before * outerBefore, -before * (outerBefore + innerBefore), bendCoupling(p));
    if (p + 1 < POINTS) {
        const float outer = inverseLength(p), middle = outer + outerBefore;
        row.x += stiffness(p) * middle * middle;
        row.y -= stiffness(p) * outerBefore * middle;
        if (p + 2 < POINTS) row.x += stiffness(p + 1) * outer * outer;
    }
    return row;
#else
    return float3(0, 0, 0);
#endif
}

Symmetric savedInverse(uint p) {
    Symmetric inverse;
    inverse.first = inverseFirst(p);
    inverse.rest = inverseRest(p);
    return inverse;
}

/// Of coil springs, and of angular ones beside them: (M − h² ∂f/∂x) d = M u + h² f, block-pentadiagonal with scalar
/// couplings two points apart, by LDLᵀ from root to tip. The inverse of its blocks of D and the blocks of L to the point
/// before are kept, and the right side.
void solveSprings(bool angular) {
    Symmetric inner = coilJacobian(FIRST_FREE - 1);
    Symmetric last, beforeLast;  // inverses of the blocks of the last two points
    last.first = last.rest = beforeLast.first = beforeLast.rest = float3(0, 0, 0);
    float3 lastX = float3(0, 0, 0), lastY = float3(0, 0, 0), lastZ = float3(0, 0, 0);  // rows of L of the last point
    float3 one = float3(0, 0, 0), two = float3(0, 0, 0);                               // right sides of the last two
    EACH for (uint p = FIRST_FREE; p < POINTS; ++p) {
        Symmetric outer;
        outer.first = outer.rest = float3(0, 0, 0);
        if (p + 1 < POINTS) outer = coilJacobian(p);
        const float3 bend = angular ? bendRow(p) : float3(0, 0, 0);
        const float mass = 1.0 / inverseMass(p), own = mass + bend.x;
        Symmetric diagonal;
        diagonal.first = inner.first + outer.first + float3(own, 0, 0);
        diagonal.rest = inner.rest + outer.rest + float3(own, 0, own);
        float3 x = float3(bend.y - inner.first.x, -inner.first.y, -inner.first.z);
        float3 y = float3(-inner.first.y, bend.y - inner.rest.x, -inner.rest.y);
        float3 z = float3(-inner.first.z, -inner.rest.y, bend.y - inner.rest.z);
        float3 side = (position(p) - previous(p)) * mass;
        if (p == FIRST_FREE) {
            const float3 moved = stepDisplacement(p - 1);
            side -= float3(dot(x, moved), dot(y, moved), dot(z, moved));
        }
        if (p >= 2 && p < FIRST_FREE + 2) side -= stepDisplacement(p - 2) * bend.z;
        if (p > FIRST_FREE + 1) {
            // What the point two before has to do with the last one.
            x -= float3(lastX.x, lastY.x, lastZ.x) * bend.z;
            y -= float3(lastX.y, lastY.y, lastZ.y) * bend.z;
            z -= float3(lastX.z, lastY.z, lastZ.z) * bend.z;
            diagonal.first -= beforeLast.first * (bend.z * bend.z);
            diagonal.rest -= beforeLast.rest * (bend.z * bend.z);
            side -= times(beforeLast, two) * bend.z;
        }
        if (p > FIRST_FREE) {
            lastX = times(last, x);
            lastY = times(last, y);
            lastZ = times(last, z);
            diagonal.first -= float3(dot(lastX, x), dot(lastX, y), dot(lastX, z));
            diagonal.rest -= float3(dot(lastY, y), dot(lastY, z), dot(lastZ, z));
            side -= float3(dot(lastX, one), dot(lastY, one), dot(lastZ, one));
        }
        beforeLast = last;
        last = inverseOfMatrix(diagonal);
        setInverseFirst(p, last.first);
        setInverseRest(p, last.rest);
        setLowerX(p, lastX);
        setLowerY(p, lastY);
        setLowerZ(p, lastZ);
        setWork(p, side);
        two = one;
        one = side;
        inner = outer;
    }
    float3 next = float3(0, 0, 0), second = float3(0, 0, 0);           // of the next two points
    float3 x = float3(0, 0, 0), y = float3(0, 0, 0), z = float3(0, 0, 0);  // rows of L of the next
    EACH for (int q = int(POINTS) - 1; q >= FIRST_FREE; --q) {
        const float coupling = angular ? bendCoupling(uint(q) + 2) : 0.0;
        const float3 moved = times(savedInverse(q), work(q) - second * coupling) - (x * next.x + y * next.y + z * next.z);
        x = lowerX(q);
        y = lowerY(q);
        z = lowerZ(q);
        second = next;
        next = moved;
        setPrevious(q, start(q));
        setPosition(q, start(q) + moved);
    }
    [unroll] for (uint c = 0; c < FIRST_FREE; ++c) {
        setPrevious(c, start(c));
        setPosition(c, start(c) + stepDisplacement(c));
    }
}
void stageImplicitSpring() { solveSprings(false); }
void stageImplicitSpringBend() { solveSprings(true); }
#endif
#endif
#endif
