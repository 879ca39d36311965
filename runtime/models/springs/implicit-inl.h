// SPDX-License-Identifier: MIT
// Backward Euler: a direct solve along each strand.
#if defined(HAIRLOOM_RUNTIME_IMPLICIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_IMPLICIT_INL_H
#undef HAIRLOOM_RUNTIME_IMPLICIT_INL_H
#else
#define HAIRLOOM_RUNTIME_IMPLICIT_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/bend_solve-inl.h"
#include "models/springs/spring_block.h"
#include "models/springs/springs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// A symmetric matrix.
struct S3 {
    V xx, xy, xz, yy, yz, zz;
};
HWY_INLINE V3 operator*(const S3& s, V3 v) {
    return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
            s.xz * v.x + s.yz * v.y + s.zz * v.z};
}
HWY_INLINE V3 operator*(const M3& m, V3 v) {
    return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
HWY_INLINE V3 transposedTimes(const M3& m, V3 v) {
    return m.x * v.x + m.y * v.y + m.z * v.z;
}
/// m·s, row by row.
HWY_INLINE M3 multiply(const M3& m, const S3& s) {
    return {s * m.x, s * m.y, s * m.z};
}
/// Of a positive definite matrix, by LDLᵀ: cofactors would lose what is soft beside what is stiff. What
/// rounding makes of the softest stays positive.
HWY_INLINE S3 inverseOf(const S3& s) {
    const V zero = hn::Zero(D()), one = all(1.0f), tiny = all(1e-7f);
    const V first = one / s.xx;
    const V xy = s.xy * first, xz = s.xz * first;
    const V second = one / hn::Max(s.yy - xy * s.xy, s.yy * tiny);
    const V rest = s.yz - xy * s.xz;
    const V yz = rest * second;
    const V third = one / hn::Max(s.zz - xz * s.xz - yz * rest, s.zz * tiny);
    // The last rows of the inverse of L.
    const V a = zero - xy, b = xy * yz - xz, c = zero - yz;
    return {first + a * a * second + b * b * third,
            a * second + b * c * third,
            b * third,
            second + c * c * third,
            c * third,
            third};
}

/// Closes a step of backward Euler whose displacement is `stepDisplacement`.
HWY_INLINE void finishImplicit(const SpringBlock& block, std::size_t i, V3 stepDisplacement) {
    const V3 start = load3(block.start, i);
    store3(start + stepDisplacement, block.position, i);
    store3(start, block.previous, i);
}

/// Puts clamped points to the end of their way.
HWY_INLINE void finishClamped(const SpringBlock& block) {
    const std::size_t end = std::size_t{block.firstFree} * kBlockLanes;
    for (std::size_t i = 0; i < end; i += kWidth) {
        const V3 start = load3(block.start, i);
        store3(start, block.previous, i);
        store3(start + load3(block.stepDisplacement, i), block.position, i);
    }
}

/// Backward Euler without stiff forces: symplectic Euler.
void advanceFree(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    finishClamped(block);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{block.firstFree} * kBlockLanes; i < end; i += kWidth)
        finishImplicit(block, i, load3(block.position, i) - load3(block.previous, i));
}

/// Backward Euler (Eq. 9) with angular springs: (M + h² K) d = M u + h² f, where u + h² f/M is the
/// displacement that the forces left, so that d = u + h² f/M + δ with (M + h² K) δ = −h² K of it.
void advanceImplicitBend(const SpringBlock& block, LaneFrame& lanes, const SubstepContext&) {
    if (block.points <= block.firstFree) return finishClamped(block);
    const auto stepDisplacementAt = [&](std::size_t i) HWY_ATTR {
        return load3(block.position, i) - load3(block.previous, i);
    };
    Strip strip(lanes);
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        V3 behind = zero3(), from = stepDisplacementAt(lane);
        const auto jointPull = [&](std::uint32_t j) HWY_ATTR {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane;
            const V3 to = stepDisplacementAt(i + kBlockLanes);
            const V3 turning = (to - from) * hn::Load(D(), block.inverseLength + i);
            const V3 pull = (turning - behind) * hn::Load(D(), block.stiffness + i);
            from = to;
            behind = turning;
            return pull;
        };
        V3 pull = zero3();
        for (std::uint32_t j = 0; j < block.firstFree && j + 1 < block.points; ++j) pull = jointPull(j);
        std::uint32_t s = block.firstFree - 1;
        const auto forceOf = [&](const auto& row, const Strip::Point&, auto isLast) HWY_ATTR {
            const V3 inner = pull;
            pull = isLast ? zero3() : jointPull(++s);
            return (inner - pull) * row.inverseLength();
        };
        const PlaneRows rows(block, lane);
        reduceBend(block, rows, strip, forceOf);
        std::size_t i = std::size_t{block.points - 1} * kBlockLanes + lane;
        const auto finish = [&](const auto&, const Strip::Point&, V3 delta) HWY_ATTR {
            finishImplicit(block, i, stepDisplacementAt(i) + delta);
            i -= kBlockLanes;
        };
        finishBend(block, rows, strip, finish, finish);
    }
    finishClamped(block);
}

/// Scalar entries of h²·K of the angular springs at point p (docs/engine.md).
struct BendRow {
    V diagonal, coupling1, coupling2;
};
HWY_INLINE BendRow bendRow(const SpringBlock& block, std::uint32_t p, std::size_t i) {
    const V zero = hn::Zero(D());
    const auto stiffness = [&](std::size_t at) { return hn::Load(D(), block.stiffness + at); };
    const auto share = [&](std::size_t at) { return hn::Load(D(), block.inverseLength + at); };
    const V outerBefore = share(i - kBlockLanes);
    const V innerBefore = p > 1 ? share(i - 2 * kBlockLanes) : zero;
    const V before = stiffness(i - kBlockLanes) * outerBefore;
    BendRow row{before * outerBefore, zero - before * (outerBefore + innerBefore), before * innerBefore};
    if (p + 1 < block.points) {
        const V middle = share(i) + outerBefore;
        row.diagonal = row.diagonal + stiffness(i) * middle * middle;
        row.coupling1 = row.coupling1 - stiffness(i) * outerBefore * middle;
    }
    if (p + 2 < block.points) row.diagonal = row.diagonal + stiffness(i + kBlockLanes) * share(i) * share(i);
    return row;
}

/// h² times the Jacobian of the coil spring of segment s; its compressive part, which would make the matrix
/// indefinite, is left out (as Choi and Ko 2002).
HWY_INLINE S3 coilJacobian(const SpringBlock& block, const SubstepContext& context, std::size_t s) {
    const std::size_t o = s + kBlockLanes;
    const Edge edge = edgeOf(load3(block.start, o) - load3(block.start, s));
    const V step =
        coilStep(context, hn::Load(D(), block.inverseMass + s), hn::Load(D(), block.inverseMass + o));
    const V slack = hn::Load(D(), block.length + s) / hn::Max(edge.size, all(1e-10f));
    const V across = step * hn::Max(all(1.0f) - slack, hn::Zero(D()));
    const V along = step - across;
    const V3 d = edge.direction;
    return {across + along * d.x * d.x, along * d.x * d.y, along * d.x * d.z,
            across + along * d.y * d.y, along * d.y * d.z, across + along * d.z * d.z};
}

/// The block-pentadiagonal system of a vector of strands by LDLᵀ, root to tip; couplings two points apart are
/// scalar.
struct StrandSystem {
    struct Point {
        S3 inverse;
        M3 lower;
        V second;
        V3 right;
    };
    Point* points;
};

/// Of point p: its own block and those to the point before and to the one before that.
struct SystemRow {
    S3 diagonal;
    M3 coupling;
    V second;
};

/// The coupling of two points by a scalar and by a segment.
HWY_INLINE M3 couplingOf(V scalar, const S3& segment) {
    const V zero = hn::Zero(D());
    return {{scalar - segment.xx, zero - segment.xy, zero - segment.xz},
            {zero - segment.xy, scalar - segment.yy, zero - segment.yz},
            {zero - segment.xz, zero - segment.yz, scalar - segment.zz}};
}

/// Eliminates the points before p, whose first is `first`, from its row.
HWY_INLINE void factorPoint(StrandSystem& system, std::uint32_t first, std::uint32_t p, SystemRow row) {
    M3& coupling = row.coupling;
    S3& diagonal = row.diagonal;
    V second = hn::Zero(D());
    if (p > first + 1) {
        second = row.second;
        const M3& before = system.points[p - 1].lower;
        coupling.x = coupling.x - V3{before.x.x, before.y.x, before.z.x} * second;
        coupling.y = coupling.y - V3{before.x.y, before.y.y, before.z.y} * second;
        coupling.z = coupling.z - V3{before.x.z, before.y.z, before.z.z} * second;
        const S3& far = system.points[p - 2].inverse;
        const V squared = second * second;
        diagonal = {diagonal.xx - far.xx * squared, diagonal.xy - far.xy * squared,
                    diagonal.xz - far.xz * squared, diagonal.yy - far.yy * squared,
                    diagonal.yz - far.yz * squared, diagonal.zz - far.zz * squared};
    }
    M3 lower{zero3(), zero3(), zero3()};
    if (p > first) {
        lower = multiply(coupling, system.points[p - 1].inverse);
        diagonal = {diagonal.xx - dot(lower.x, coupling.x), diagonal.xy - dot(lower.x, coupling.y),
                    diagonal.xz - dot(lower.x, coupling.z), diagonal.yy - dot(lower.y, coupling.y),
                    diagonal.yz - dot(lower.y, coupling.z), diagonal.zz - dot(lower.z, coupling.z)};
    }
    system.points[p].inverse = inverseOf(diagonal);
    system.points[p].lower = lower;
    system.points[p].second = second;
}

/// Solves for `right`, which it uses up, and calls take(p, solution) from tip to root.
template <class Take>
HWY_INLINE void solveSystem(StrandSystem& system, std::uint32_t first, std::uint32_t points, Take&& take) {
    for (std::uint32_t p = first + 1; p < points; ++p) {
        V3 right = system.points[p].right;
        if (p > first + 1)
            right =
                right - (system.points[p - 2].inverse * system.points[p - 2].right) * system.points[p].second;
        system.points[p].right = right - system.points[p].lower * system.points[p - 1].right;
    }
    V3 next1 = zero3(), next2 = zero3();
    for (std::uint32_t p = points; p-- > first;) {
        V3 solution = system.points[p].inverse * system.points[p].right;
        if (p + 1 < points) solution = solution - transposedTimes(system.points[p + 1].lower, next1);
        if (p + 2 < points)
            solution = solution - (system.points[p].inverse * next2) * system.points[p + 2].second;
        take(p, solution);
        next2 = next1;
        next1 = solution;
    }
}

/// Backward Euler (Eq. 9) with coil springs: (M − h² ∂f/∂x) d = M u + h² f.
template <bool kAngular>
void advanceImplicitSpring(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    const V zero = hn::Zero(D());
    StrandSystem system{reinterpret_cast<StrandSystem::Point*>(lanes.solver)};
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const std::uint32_t first = block.firstFree;
        S3 inner = coilJacobian(block, context, std::size_t{first - 1} * kBlockLanes + lane);
        for (std::uint32_t p = first; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            S3 outer{zero, zero, zero, zero, zero, zero};
            if (p + 1 < block.points) outer = coilJacobian(block, context, i);
            BendRow bend{zero, zero, zero};
            if constexpr (kAngular) bend = bendRow(block, p, i);
            const V mass = all(1.0f) / hn::Load(D(), block.inverseMass + i);
            const V own = mass + bend.diagonal;
            const SystemRow row{{inner.xx + outer.xx + own, inner.xy + outer.xy, inner.xz + outer.xz,
                                 inner.yy + outer.yy + own, inner.yz + outer.yz, inner.zz + outer.zz + own},
                                couplingOf(bend.coupling1, inner),
                                bend.coupling2};
            V3 right = (load3(block.position, i) - load3(block.previous, i)) * mass;
            if (p == first) right = right - row.coupling * load3(block.stepDisplacement, i - kBlockLanes);
            if (kAngular && p < first + 2 && p >= 2)
                right = right - load3(block.stepDisplacement, i - 2 * kBlockLanes) * bend.coupling2;
            factorPoint(system, first, p, row);
            system.points[p].right = right;
            inner = outer;
        }
        solveSystem(system, first, block.points, [&](std::uint32_t p, V3 stepDisplacement) {
            finishImplicit(block, std::size_t{p} * kBlockLanes + lane, stepDisplacement);
        });
    }
    finishClamped(block);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
