// SPDX-License-Identifier: MIT
// Bending and inextensible segments solved as one system along each strand (docs/engine.md, "Coupled"). A thread
// for each strand.
#if HAIR_COUPLED

// γ of the lengths as a multiple of the masses beside a segment; what is added for the tension that it carries, as a
// multiple of tension over length; and the most of that.
#define HARDNESS 2000.0
#define LOAD_HARDNESS 300.0
#define MAX_HARDNESS 1e5
// How often the system is solved at most, with the same factors, until no segment's length is wrong by more than this
// share of it, and by what rounding makes of places.
#define MAX_SOLVES 6
#define SOLVED 3e-7
#define ROUNDING 2.4e-7
// Tension that may act along the segments as they start, as ω²h² of the wave across them; Verlet's limit is 4.
#define HELD_TENSION 1.0

/// A symmetric matrix: xx xy xz, yy yz zz.
struct Symmetric {
    float3 a, b;
};
/// Rows.
struct Matrix {
    float3 x, y, z;
};

float3 times(Symmetric s, float3 v) {
    return float3(dot(s.a, v), s.a.y * v.x + s.b.x * v.y + s.b.y * v.z, s.a.z * v.x + s.b.y * v.y + s.b.z * v.z);
}
float3 times(Matrix m, float3 v) { return float3(dot(m.x, v), dot(m.y, v), dot(m.z, v)); }
float3 transposedTimes(Matrix m, float3 v) { return m.x * v.x + m.y * v.y + m.z * v.z; }

/// Of a positive definite matrix, by LDLᵀ: cofactors would lose what is soft beside what is stiff. What rounding makes
/// of the softest stays positive.
Symmetric inverted(Symmetric s) {
    const float first = 1.0 / s.a.x;
    const float xy = s.a.y * first, xz = s.a.z * first;
    const float second = 1.0 / max(s.b.x - xy * s.a.y, s.b.x * 1e-7);
    const float rest = s.b.y - xy * s.a.z;
    const float yz = rest * second;
    const float third = 1.0 / max(s.b.z - xz * s.a.z - yz * rest, s.b.z * 1e-7);
    const float i = -xy, j = xy * yz - xz, k = -yz;  // the last rows of the inverse of L
    Symmetric result;
    result.a = float3(first + i * i * second + j * j * third, i * second + j * k * third, j * third);
    result.b = float3(second + k * k * third, k * third, third);
    return result;
}

// LDLᵀ of the block-pentadiagonal matrix, root to tip: inverse of each point's own block, its coupling to the point
// before, and, a scalar, to the one before that. Of segments: the direction along which they are held, and how hard,
// how hard across it, and what is wrong with their length.
SCRATCH_ARRAY(inverseA, setInverseA, gInverseA, 5)
SCRATCH_ARRAY(inverseB, setInverseB, gInverseB, 8)
SCRATCH_ARRAY(lowerX, setLowerX, gLowerX, 11)
SCRATCH_ARRAY(lowerY, setLowerY, gLowerY, 14)
SCRATCH_ARRAY(lowerZ, setLowerZ, gLowerZ, 17)
SCRATCH_ARRAY(side, setSide, gSides, 20)
SCRATCH_ARRAY(held, setHeld, gHeld, 23)
SCRATCH_ARRAY(hold, setHold, gHolds, 26)
#define second upper
#define setSecond setUpper

Symmetric inverseAt(uint p) {
    Symmetric s;
    s.a = inverseA(p);
    s.b = inverseB(p);
    return s;
}
Matrix lowerAt(uint p) {
    Matrix m;
    m.x = lowerX(p);
    m.y = lowerY(p);
    m.z = lowerZ(p);
    return m;
}

Symmetric stiffnessOf(uint s) {
    const float3 d = held(s), h = hold(s), g = d * h.x;
    Symmetric result;
    result.a = float3(h.y + g.x * d.x, g.x * d.y, g.x * d.z);
    result.b = float3(h.y + g.y * d.y, g.y * d.z, h.y + g.z * d.z);
    return result;
}

/// What holds a segment against turning where it carries `load`, of either sign: beyond what Verlet holds that grows
/// in the substep itself, and would throw light points about.
float acrossOf(float load, float inverse, float mass) { return max(abs(load) * inverse - mass * HELD_TENSION, 0.0); }

/// 1/(w + w') of the ends of segment s; those of clamped points are 0.
float reducedMass(uint s) { return 1.0 / ((s < FIRST_FREE ? 0.0 : inverseMass(s)) + inverseMass(s + 1)); }

/// Reads a segment at the start of the substep (`previous`) and after the integration (`position`). The force on its
/// inner point, reversed on its outer one: the pulls of its joints, the tension of the last substep, what turning adds
/// to that, and what gives the segment its length.
float3 openSegment(uint s) {
    const float inverse = inverseLength(s);
    const bool flat = inverse <= 0.0;
    const float3 start = previous(s + 1) - previous(s), free = position(s + 1) - position(s);
    // Segments that turn by more than 60° are held where they go.
    const float3 direction = (dot(start, free) > 0.5 * dot(free, free) ? start : free) * inverse;
    const float mass = reducedMass(s), load = tension(s);
    const float hardness = mass * HARDNESS + min(abs(load) * inverse * LOAD_HARDNESS, mass * MAX_HARDNESS);
    const float across = acrossOf(load, inverse, mass);
    const float wrong = 0.5 * (dot(free, free) * inverse - segmentLength(s));
    setHeld(s, direction);
    // Points without a distance are held together.
    setHold(s, float3(flat ? 0.0 : hardness, flat ? hardness : across, wrong));
    const float3 force = direction * (load + hardness * wrong) + (free - start) * across;
    return segmentPull(s, false) + (flat ? free * hardness : force);
}

/// The row of point p: its own block, and those that couple it to the point before and, a scalar, to the one before
/// that.
struct SystemRow {
    Symmetric diagonal;
    Matrix coupling;
    float far;
};
SystemRow rowOf(uint p, Symmetric inner) {
    const float share = 0.25 + gFrame.substep.bendRate;
    const float outerBefore = inverseLength(p - 1), innerBefore = p > 1 ? inverseLength(p - 2) : 0.0;
    const float before = stiffness(p - 1) * outerBefore;
    float own = before * outerBefore, one = -before * (outerBefore + innerBefore);
    Symmetric outer;
    outer.a = outer.b = float3(0, 0, 0);
    if (p + 1 < POINTS) {
        const float middle = inverseLength(p) + outerBefore;
        own += stiffness(p) * middle * middle;
        one -= stiffness(p) * outerBefore * middle;
        outer = stiffnessOf(p);
    }
    if (p + 2 < POINTS) own += stiffness(p + 1) * inverseLength(p) * inverseLength(p);
    const float added = 1.0 / inverseMass(p) + share * own, scalar = share * one;
    SystemRow row;
    row.diagonal.a = inner.a + outer.a + float3(added, 0, 0);
    row.diagonal.b = inner.b + outer.b + float3(added, 0, added);
    row.coupling.x = float3(scalar - inner.a.x, -inner.a.y, -inner.a.z);
    row.coupling.y = float3(-inner.a.y, scalar - inner.b.x, -inner.b.y);
    row.coupling.z = float3(-inner.a.z, -inner.b.y, scalar - inner.b.z);
    row.far = share * before * innerBefore;
    return row;
}

/// Eliminates the points before p from its row.
void factorPoint(uint p, SystemRow row) {
    float far = 0.0;
    if (p > FIRST_FREE + 1) {
        far = row.far;
        const Matrix before = lowerAt(p - 1);
        row.coupling.x -= float3(before.x.x, before.y.x, before.z.x) * far;
        row.coupling.y -= float3(before.x.y, before.y.y, before.z.y) * far;
        row.coupling.z -= float3(before.x.z, before.y.z, before.z.z) * far;
        row.diagonal.a -= inverseA(p - 2) * (far * far);
        row.diagonal.b -= inverseB(p - 2) * (far * far);
    }
    Matrix lower;
    lower.x = lower.y = lower.z = float3(0, 0, 0);
    if (p > FIRST_FREE) {
        const Symmetric before = inverseAt(p - 1);
        lower.x = times(before, row.coupling.x);
        lower.y = times(before, row.coupling.y);
        lower.z = times(before, row.coupling.z);
        row.diagonal.a -= float3(dot(lower.x, row.coupling.x), dot(lower.x, row.coupling.y), dot(lower.x, row.coupling.z));
        row.diagonal.b -= float3(dot(lower.y, row.coupling.y), dot(lower.y, row.coupling.z), dot(lower.z, row.coupling.z));
    }
    const Symmetric inverse = inverted(row.diagonal);
    setInverseA(p, inverse.a);
    setInverseB(p, inverse.b);
    setLowerX(p, lower.x);
    setLowerY(p, lower.y);
    setLowerZ(p, lower.z);
    setSecond(p, far);
}

/// Factors M + (¼ + q) h² K + segments.
void factorSystem() {
    Symmetric inner = stiffnessOf(FIRST_FREE - 1);
    [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
        factorPoint(p, rowOf(p, inner));
        if (p + 1 < POINTS) inner = stiffnessOf(p);
    }
}

void openSystem() {
    float3 inner = openSegment(FIRST_FREE - 1);
    [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
        float3 outer = float3(0, 0, 0);
        if (p + 1 < POINTS) outer = openSegment(p);
        setSide(p, outer - inner);
        inner = outer;
    }
}

/// What a solve has left of segment s, and, where it carries more tension than the system holds, what holds that.
float3 reopenSegment(uint s, inout bool wrong, inout bool loose) {
    float3 h = hold(s);
    const float3 edge = position(s + 1) - position(s);
    const float size = segmentLength(s), inverse = inverseLength(s);
    h.z = 0.5 * (dot(edge, edge) * inverse - size);
    if (inverse <= 0.0) {
        setHold(s, h);
        return edge * h.y;
    }
    const float rounded = ROUNDING * dot(abs(position(s)), float3(1, 1, 1));
    wrong = wrong || abs(h.z) > SOLVED * size + rounded;
    const float mass = reducedMass(s);
    const float tighter = acrossOf(tension(s), inverse, mass) - h.y;
    float added = 0.0;
    if (tighter > h.y + mass * HELD_TENSION) {
        loose = true;
        added = tighter;
        h.y += tighter;
    }
    setHold(s, h);
    return held(s) * (h.x * h.z) + (edge - (previous(s + 1) - previous(s))) * added;
}

void reopenSystem(out bool wrong, out bool loose) {
    wrong = loose = false;
    float3 inner = reopenSegment(FIRST_FREE - 1, wrong, loose);
    [loop] for (uint p = FIRST_FREE; p < POINTS; ++p) {
        float3 outer = float3(0, 0, 0);
        if (p + 1 < POINTS) outer = reopenSegment(p, wrong, loose);
        setSide(p, outer - inner);
        inner = outer;
    }
}

void addTension(uint s, float3 turned) {
    const float3 h = hold(s);
    setTension(s, tension(s) + h.x * (h.z + dot(held(s), turned)));
}

/// Solves, moves the points and adds to the tensions.
void moveSystem() {
    [loop] for (uint p = FIRST_FREE + 1; p < POINTS; ++p) {
        float3 right = side(p);
        if (p > FIRST_FREE + 1) right -= times(inverseAt(p - 2), side(p - 2)) * second(p);
        setSide(p, right - times(lowerAt(p), side(p - 1)));
    }
    float3 next = float3(0, 0, 0), afterNext = float3(0, 0, 0);
    [loop] for (int q = int(POINTS) - 1; q >= FIRST_FREE; --q) {
        const Symmetric inverse = inverseAt(q);
        float3 move = times(inverse, side(q));
        if (q + 1 < int(POINTS)) move -= transposedTimes(lowerAt(q + 1), next);
        if (q + 2 < int(POINTS)) move -= times(inverse, afterNext) * second(q + 2);
        setPosition(q, position(q) + move);
        if (q + 1 < int(POINTS)) addTension(q, next - move);
        afterNext = next;
        next = move;
    }
    addTension(FIRST_FREE - 1, next);
}

/// Angular springs and lengths after position Verlet, as one system: the method of multipliers (Hestenes 1969, Powell
/// 1969) from the tensions of the last substep.
void bendCoupled() {
    float share = 0.0;
#if HAIR_CURVES
    share = followFrames();
#endif
    measureAhead(share);
    openSystem();
    factorSystem();
    bool wrong = true, loose = false;
    [loop] for (uint solve = 0; solve < MAX_SOLVES; ++solve) {
        if (solve > 0) {
            reopenSystem(wrong, loose);
            if (!wrong && !loose) break;
            if (loose) factorSystem();
        }
        moveSystem();
    }
}
void stageCoupled() { bendCoupled(); }
void stageCoupledStraight() { bendCoupled(); }
#endif
