// SPDX-License-Identifier: MIT
// One segment of an elastic rod in a substep, written once for C++, where a number is a vector of strands,
// and for HLSL, where it is a number (docs/engine.md, "Rods"). Who includes it defines ROD_FUNCTION, Real,
// Real3, Real4, ROD_INOUT, ROD_OUT and ROD_NUMBER and has RodNumbers, cross, dot, mad (a b + c), mad3 (a s +
// b), negMad (c − a b), negMad3 (b − a s), maximum, minimum, absolute, root, xyz, real3, real4 and
// withSignOf.
//
// A segment is a rotation q, from its place in the rest shape, in the root's frame, to the world. A vertex
// lies between an inner and an outer segment; its strain is ε = 2 vec(p), p = q_inner⁻¹ q_outer, in the
// root's frame at rest, and its energy ½ (B |ε|² + (C − B) (a·ε)² + (B₂ − B) (n·ε)²)/l̄ with its axis a and
// the long diameter n of its section: an even function of p, so smooth for all rotations. u is a small
// rotation of a segment, world space. Masses are metres of hair, stiffnesses m³/s².
#ifndef HAIRLOOM_ROD_H
#define HAIRLOOM_ROD_H
#include "rod_constants.h"
#endif

#if !defined(HAIRLOOM_ROD_FUNCTIONS) && defined(ROD_FUNCTION)
#define HAIRLOOM_ROD_FUNCTIONS

/// Conjugate of a, times b; of the two quaternions of that rotation the one on the side of another.
ROD_FUNCTION Real4 rodRelative(Real4 a, Real4 b, Real4 other) {
    const Real3 av = xyz(a), bv = xyz(b);
    const Real w = mad(a.w, b.w, dot(av, bv));
    const Real3 v = mad3(bv, a.w, negMad3(av, b.w, cross(bv, av)));
    const Real side = mad(w, other.w, dot(v, xyz(other)));
    return real4(withSignOf(v, side), withSignOf(w, side));
}

/// About the quaternion of a strain, with w ≥ 0: as near as telling the two quaternions of a rotation apart
/// takes.
ROD_FUNCTION Real4 rodOfStrain(Real3 strain) {
    const Real3 v = strain * ROD_NUMBER(0.5);
    return real4(v, maximum(negMad(dot(v, v), ROD_NUMBER(0.5), ROD_NUMBER(1.0)), ROD_NUMBER(0.0)));
}

/// 1/(1 + |u|²/4).
ROD_FUNCTION Real rodInverseOfTurn(Real3 u) {
    return ROD_NUMBER(1.0) / mad(dot(u, u), ROD_NUMBER(0.25), ROD_NUMBER(1.0));
}

/// First q, of about unit length, then the rotation of 2 atan(|u|/2) about u (Cayley), which is legal for any
/// u. The result is nearer to unit length than q.
ROD_FUNCTION Real4 rodTurned(Real4 q, Real3 u) {
    const Real3 h = u * ROD_NUMBER(0.5), v = xyz(q);
    const Real squared = mad(q.w, q.w, dot(v, v));
    const Real scale = root(rodInverseOfTurn(u)) * negMad(squared, ROD_NUMBER(0.5), ROD_NUMBER(1.5));
    const Real w = negMad(h.x, v.x, negMad(h.y, v.y, negMad(h.z, v.z, q.w)));
    return real4((mad3(h, q.w, v) + cross(h, v)) * scale, w * scale);
}

/// What that rotation adds to a unit vector t.
ROD_FUNCTION Real3 rodTangentChange(Real3 u, Real3 t) {
    const Real3 c = cross(u, t);
    return mad3(cross(u, c), ROD_NUMBER(0.5), c) * rodInverseOfTurn(u);
}

/// Rotates v.
ROD_FUNCTION Real3 rodRotate(Real4 q, Real3 v) {
    const Real3 c = cross(xyz(q), v);
    const Real3 twice = c + c;
    return mad3(twice, q.w, v) + cross(xyz(q), twice);
}

/// Columns of a rotation.
struct RodMatrix {
    Real3 x, y, z;
};
ROD_FUNCTION RodMatrix rodMatrix(Real4 q) {
    const Real x = q.x + q.x, y = q.y + q.y, z = q.z + q.z, one = ROD_NUMBER(1.0);
    const Real xw = x * q.w, yw = y * q.w, zw = z * q.w;
    const Real yy = y * q.y, zz = z * q.z;
    RodMatrix m;
    m.x = real3(one - (yy + zz), mad(x, q.y, zw), mad(x, q.z, ROD_NUMBER(0.0) - yw));
    m.y = real3(mad(x, q.y, ROD_NUMBER(0.0) - zw), negMad(x, q.x, one - zz), mad(y, q.z, xw));
    m.z = real3(mad(x, q.z, yw), mad(y, q.z, ROD_NUMBER(0.0) - xw), negMad(x, q.x, one - yy));
    return m;
}
ROD_FUNCTION Real3 rodTimes(RodMatrix m, Real3 v) {
    return mad3(m.z, v.z, mad3(m.y, v.y, m.x * v.x));
}

/// How a vertex resists beside B |ε|²/l̄: to twist about its axis, and, where the section is flat, to a bend
/// about its long diameter, which is softer. Directions in the root's frame at rest.
struct RodSection {
    Real3 axis, normal;
    Real twist, flat;  ///< (C − B)/l̄ and (B₂ − B)/l̄
    bool twists, isFlat;
};

/// By how much damping stiffens a vertex in a step of 1/inverseStep seconds (Kelvin-Voigt): 1 + τ/h.
ROD_FUNCTION Real rodDamped(RodNumbers numbers, Real inverseStep) {
    return ROD_NUMBER(1.0) + ROD_NUMBER(numbers.bendDampingTime) * inverseStep;
}

/// Twice the energy of a strain e with `bend` for B/l̄.
ROD_FUNCTION Real rodTwiceEnergy(Real3 e, Real bend, RodSection section) {
    Real sum = bend * dot(e, e);
    if (section.twists) {
        const Real along = dot(e, section.axis);
        sum = mad(bend, dot(e, e), section.twist * along * along);
    }
    if (section.isFlat) {
        const Real across = dot(e, section.normal);
        sum = mad(section.flat * across, across, sum);
    }
    return sum;
}

/// How a pose pulls at a node of `mass` that it is `way` from, m/s²: as a spring that hair follows at `rate`
/// 1/s, and beyond what a speed makes of that with a steady pull.
ROD_FUNCTION Real rodPosePull(Real mass, Real rate, Real3 way) {
    const Real apart = maximum(root(dot(way, way)), ROD_NUMBER(1e-9));
    return mass * rate * minimum(rate, ROD_NUMBER(2.0 * HAIRLOOM_POSE_SPEED) / apart);
}
/// Twice the energy of that pull.
ROD_FUNCTION Real rodPoseTwiceEnergy(Real mass, Real rate, Real3 way) {
    const Real reached = rate * root(dot(way, way));
    const Real taken = minimum(reached, ROD_NUMBER(2.0 * HAIRLOOM_POSE_SPEED));
    return mass * taken * (reached + reached - taken);
}

/// A symmetric matrix: xx, xy, xz, yy, yz, zz.
struct RodSymmetric {
    Real m[6];
};
/// Adds k T Tᵀ.
ROD_FUNCTION void rodAddOuter(ROD_INOUT(RodSymmetric) S, Real3 T, Real k) {
    const Real3 kt = T * k;
    S.m[0] = mad(kt.x, T.x, S.m[0]);
    S.m[1] = mad(kt.x, T.y, S.m[1]);
    S.m[2] = mad(kt.x, T.z, S.m[2]);
    S.m[3] = mad(kt.y, T.y, S.m[3]);
    S.m[4] = mad(kt.y, T.z, S.m[4]);
    S.m[5] = mad(kt.z, T.z, S.m[5]);
}

/// What lies beyond a node, as a quadratic form in the node's displacement x and in the rotation u of the
/// segment before it: ½ xᵀP x + xᵀR u + ½ uᵀU u + gx·x + gu·u. P and U are symmetric: xx, xy, xz, yy, yz, zz.
struct RodForm {
    Real P[6];
    Real R[9];  ///< by rows
    Real U[6];
    Real3 gx, gu;
    Real3 force;  ///< what the nodes beyond pull with, which is the tension of the segment
};

/// The rotation of a segment is u_before − d with d = k + K (x, u_before), where x is the displacement of its
/// inner node and u_before the rotation of the segment before, both beyond what was predicted.
struct RodGains {
    Real k[21];  ///< rows of three: each with 3 for x, 3 for u, 1 alone
};

/// A node of weight mi = m/(h² D), whose gradient at the prediction is r. It pulls at its segments with
/// `pull`: r where a motion was predicted, else nothing, since r is then mostly what stops the node.
ROD_FUNCTION void rodAddNode(ROD_INOUT(RodForm) f, Real mi, Real3 r, Real3 pull) {
    f.P[0] = f.P[0] + mi;
    f.P[3] = f.P[3] + mi;
    f.P[5] = f.P[5] + mi;
    f.gx = f.gx + r;
    f.force = f.force + pull;
}

/// A node's contacts: the Hessian `h` (as P) of their potentials.
ROD_FUNCTION void rodAddContact(ROD_INOUT(RodForm) f, Real h0, Real h1, Real h2, Real h3, Real h4, Real h5) {
    f.P[0] = f.P[0] + h0;
    f.P[1] = f.P[1] + h1;
    f.P[2] = f.P[2] + h2;
    f.P[3] = f.P[3] + h3;
    f.P[4] = f.P[4] + h4;
    f.P[5] = f.P[5] + h5;
}

/// 1/D of a pivot D, which is no smaller than `least`. One that is as far below 0 is rounding of what lies
/// beyond, and each segment would make a million times as much of it: nothing turns there.
ROD_FUNCTION Real rodInverse(Real pivot, Real least) {
    const Real none = ROD_NUMBER(0.0);
    return choose(pivot < none - least, none, ROD_NUMBER(1.0) / maximum(pivot, least));
}

/// Takes a form from a segment's outer node to its inner one and eliminates the segment's rotation. `q` is
/// the segment's rotation, t its tangent, `relative` the p of the vertex at its inner node, e the strain
/// there less what it is pulled to.
ROD_FUNCTION void rodEliminate(ROD_INOUT(RodForm) f, Real4 q, Real3 t, Real segment, Real4 relative, Real3 e,
                               Real bend, RodSection section, ROD_OUT(RodGains) gains) {
    // Displacements: outer = inner + l u × t.
    const Real3 lt = t * segment;
    const Real3 P0 = real3(f.P[0], f.P[1], f.P[2]), P1 = real3(f.P[1], f.P[3], f.P[4]),
                P2 = real3(f.P[2], f.P[4], f.P[5]);
    const Real3 W0 = real3(f.R[0], f.R[1], f.R[2]) + cross(lt, P0);
    const Real3 W1 = real3(f.R[3], f.R[4], f.R[5]) + cross(lt, P1);
    const Real3 W2 = real3(f.R[6], f.R[7], f.R[8]) + cross(lt, P2);
    const Real3 a0 = cross(lt, real3(W0.x, W1.x, W2.x)), a1 = cross(lt, real3(W0.y, W1.y, W2.y)),
                a2 = cross(lt, real3(W0.z, W1.z, W2.z));
    const Real3 b0 = cross(lt, real3(f.R[0], f.R[3], f.R[6])), b1 = cross(lt, real3(f.R[1], f.R[4], f.R[7])),
                b2 = cross(lt, real3(f.R[2], f.R[5], f.R[8]));
    // Tension turns a segment back: the positive part of l (T (1 − t tᵀ) + (p tᵀ + t pᵀ)/2), T = −F·t, p = F
    // − (F·t) t.
    const Real along = dot(f.force, t);
    const Real tension = maximum(ROD_NUMBER(0.0) - along, ROD_NUMBER(0.0)) * segment;
    const Real3 across = negMad3(t, along, f.force);
    const Real size = root(dot(across, across));
    const Real3 pull = mad3(across, ROD_NUMBER(1.0) / maximum(size, ROD_NUMBER(1e-12)), t);
    const Real pk = segment * size * ROD_NUMBER(0.25);
    const Real3 tt = t * tension, pp = pull * pk;
    const Real Y0 = f.U[0] + a0.x + b0.x + tension + negMad(tt.x, t.x, pp.x * pull.x);
    const Real Y1 = f.U[1] + a1.x + b0.y + negMad(tt.x, t.y, pp.x * pull.y);
    const Real Y2 = f.U[2] + a2.x + b0.z + negMad(tt.x, t.z, pp.x * pull.z);
    const Real Y3 = f.U[3] + a1.y + b1.y + tension + negMad(tt.y, t.y, pp.y * pull.y);
    const Real Y4 = f.U[4] + a2.y + b1.z + negMad(tt.y, t.z, pp.y * pull.z);
    const Real Y5 = f.U[5] + a2.z + b2.z + tension + negMad(tt.z, t.z, pp.z * pull.z);
    const Real3 gu = f.gu + cross(lt, f.gx);

    // The vertex. With J = w + [v]× the strain changes by J Rᵀ (u_outer − u_inner); JᵀJ = 1 − v vᵀ.
    const RodMatrix m = rodMatrix(q);
    const Real3 v = xyz(relative);
    Real3 moment = e * bend;
    if (section.twists) moment = mad3(section.axis, section.twist * dot(section.axis, e), moment);
    if (section.isFlat) moment = mad3(section.normal, section.flat * dot(section.normal, e), moment);
    const Real3 g = rodTimes(m, mad3(moment, relative.w, cross(moment, v)));
    const Real3 swing = rodTimes(m, v), bv = swing * bend;
    RodSymmetric S;
    // Nothing but the vertex resists the twist of a segment. Where it hardly does, rounding would.
    const Real firm =
        mad(absolute(Y0) + absolute(Y3) + absolute(Y5), ROD_NUMBER(HAIRLOOM_ROD_FIRMNESS), bend);
    S.m[0] = Y0 + negMad(bv.x, swing.x, firm);
    S.m[1] = negMad(bv.x, swing.y, Y1);
    S.m[2] = negMad(bv.x, swing.z, Y2);
    S.m[3] = Y3 + negMad(bv.y, swing.y, firm);
    S.m[4] = negMad(bv.y, swing.z, Y4);
    S.m[5] = Y5 + negMad(bv.z, swing.z, firm);
    if (section.twists)
        rodAddOuter(S, rodTimes(m, mad3(section.axis, relative.w, cross(section.axis, v))), section.twist);
    if (section.isFlat)
        rodAddOuter(S, rodTimes(m, mad3(section.normal, relative.w, cross(section.normal, v))), section.flat);

    // S = L D Lᵀ, with pivots no smaller than what rounding leaves of them.
    const Real least = mad(
        bend, ROD_NUMBER(HAIRLOOM_ROD_LEAST_PIVOT),
        (absolute(S.m[0]) + absolute(S.m[3]) + absolute(S.m[5])) * ROD_NUMBER(HAIRLOOM_ROD_PIVOT_ROUNDING));
    const Real i0 = rodInverse(S.m[0], least);
    const Real l1 = S.m[1] * i0, l2 = S.m[2] * i0;
    const Real i1 = rodInverse(negMad(l1, S.m[1], S.m[3]), least);
    const Real s3 = negMad(l1, S.m[2], S.m[4]), l3 = s3 * i1;
    const Real i2 = rodInverse(negMad(l3, s3, negMad(l2, S.m[2], S.m[5])), least);

    // Columns of L⁻¹ [Wᵀ Y g], and S⁻¹ of them.
    const Real3 total = gu + g;
    const Real3 N[7] = {W0, W1, W2, real3(Y0, Y1, Y2), real3(Y1, Y3, Y4), real3(Y2, Y4, Y5), total};
    Real3 Z[7], ZD[7];
    ROD_UNROLL for (int c = 0; c < 7; ++c) {
        const Real z0 = N[c].x, z1 = negMad(l1, z0, N[c].y), z2 = negMad(l3, z1, negMad(l2, z0, N[c].z));
        Z[c] = real3(z0, z1, z2);
        ZD[c] = real3(z0 * i0, z1 * i1, z2 * i2);
        const Real k2 = ZD[c].z, k1 = negMad(l3, k2, ZD[c].y), k0 = negMad(l1, k1, negMad(l2, k2, ZD[c].x));
        gains.k[c] = k0;
        gains.k[7 + c] = k1;
        gains.k[14 + c] = k2;
    }

    f.P[0] = f.P[0] - dot(Z[0], ZD[0]);
    f.P[1] = f.P[1] - dot(Z[0], ZD[1]);
    f.P[2] = f.P[2] - dot(Z[0], ZD[2]);
    f.P[3] = f.P[3] - dot(Z[1], ZD[1]);
    f.P[4] = f.P[4] - dot(Z[1], ZD[2]);
    f.P[5] = f.P[5] - dot(Z[2], ZD[2]);
    f.R[0] = W0.x - dot(Z[0], ZD[3]);
    f.R[1] = W0.y - dot(Z[0], ZD[4]);
    f.R[2] = W0.z - dot(Z[0], ZD[5]);
    f.R[3] = W1.x - dot(Z[1], ZD[3]);
    f.R[4] = W1.y - dot(Z[1], ZD[4]);
    f.R[5] = W1.z - dot(Z[1], ZD[5]);
    f.R[6] = W2.x - dot(Z[2], ZD[3]);
    f.R[7] = W2.y - dot(Z[2], ZD[4]);
    f.R[8] = W2.z - dot(Z[2], ZD[5]);
    f.U[0] = Y0 - dot(Z[3], ZD[3]);
    f.U[1] = Y1 - dot(Z[3], ZD[4]);
    f.U[2] = Y2 - dot(Z[3], ZD[5]);
    f.U[3] = Y3 - dot(Z[4], ZD[4]);
    f.U[4] = Y4 - dot(Z[4], ZD[5]);
    f.U[5] = Y5 - dot(Z[5], ZD[5]);
    f.gx = real3(f.gx.x - dot(Z[0], ZD[6]), f.gx.y - dot(Z[1], ZD[6]), f.gx.z - dot(Z[2], ZD[6]));
    f.gu = real3(gu.x - dot(Z[3], ZD[6]), gu.y - dot(Z[4], ZD[6]), gu.z - dot(Z[5], ZD[6]));
}

/// One of the three numbers of d, of which `row` gives the gains.
ROD_FUNCTION Real rodGain(RodGains g, int row, Real share, Real3 x, Real3 u) {
    const int at = 7 * row;
    const Real ofX = mad(g.k[at], x.x, mad(g.k[at + 1], x.y, g.k[at + 2] * x.z));
    const Real ofU = mad(g.k[at + 3], u.x, mad(g.k[at + 4], u.y, g.k[at + 5] * u.z));
    return mad(share, g.k[at + 6], ofX + ofU);
}

#endif
