// SPDX-License-Identifier: MIT
// Backward Euler with coil springs: a direct solve along each strand.
#if defined(HAIRLOOM_RUNTIME_IMPLICIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_IMPLICIT_INL_H
#undef HAIRLOOM_RUNTIME_IMPLICIT_INL_H
#else
#define HAIRLOOM_RUNTIME_IMPLICIT_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/bend-inl.h"
#include "runtime/kernels/lanes-inl.h"
#include "runtime/kernels/springs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// A symmetric matrix.
struct S3 {
    V xx, xy, xz, yy, yz, zz;
};
/// Rows.
struct M3 {
    V3 x, y, z;
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
HWY_INLINE S3 inverseOf(const S3& s) {
    const V a = s.yy * s.zz - s.yz * s.yz, b = s.xz * s.yz - s.xy * s.zz, c = s.xy * s.yz - s.xz * s.yy;
    const V inverse = all(1.0f) / (s.xx * a + s.xy * b + s.xz * c);
    return {a * inverse,
            b * inverse,
            c * inverse,
            (s.xx * s.zz - s.xz * s.xz) * inverse,
            (s.xy * s.xz - s.xx * s.yz) * inverse,
            (s.xx * s.yy - s.xy * s.xy) * inverse};
}

/// Scalar entries of h²·K of the angular springs at point p (docs/engine.md).
struct BendRow {
    V diagonal, coupling1, coupling2;
};
HWY_INLINE BendRow bendRow(const BlockView& block, std::uint32_t p, std::size_t i) {
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
HWY_INLINE S3 coilJacobian(const BlockView& block, const SubstepContext& context, std::size_t s) {
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

/// Factors and right sides of one strand of lanes, root to tip.
struct SpringSystem {
    S3 inverse[kMaxPoints];
    M3 lower[kMaxPoints];
    V second[kMaxPoints];
    V3 right[kMaxPoints];
};

/// Backward Euler (Eq. 9) with coil springs: (M − h² ∂f/∂x) d = M u + h² f, block-pentadiagonal, by LDLᵀ.
template <bool kAngular>
void advanceImplicitSpring(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    const V zero = hn::Zero(D());
    SpringSystem system;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
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
            S3 diagonal{inner.xx + outer.xx + own, inner.xy + outer.xy, inner.xz + outer.xz,
                        inner.yy + outer.yy + own, inner.yz + outer.yz, inner.zz + outer.zz + own};
            M3 coupling{{bend.coupling1 - inner.xx, zero - inner.xy, zero - inner.xz},
                        {zero - inner.xy, bend.coupling1 - inner.yy, zero - inner.yz},
                        {zero - inner.xz, zero - inner.yz, bend.coupling1 - inner.zz}};
            V3 right = (load3(block.position, i) - load3(block.previous, i)) * mass;
            if (p == first) right = right - coupling * load3(block.rate, i - kBlockLanes);
            if (kAngular && p < first + 2 && p >= 2)
                right = right - load3(block.rate, i - 2 * kBlockLanes) * bend.coupling2;
            V second = zero;
            if (p > first + 1) {
                second = bend.coupling2;
                const M3& before = system.lower[p - 1];
                coupling.x = coupling.x - V3{before.x.x, before.y.x, before.z.x} * second;
                coupling.y = coupling.y - V3{before.x.y, before.y.y, before.z.y} * second;
                coupling.z = coupling.z - V3{before.x.z, before.y.z, before.z.z} * second;
                const S3& far = system.inverse[p - 2];
                const V squared = second * second;
                diagonal = {diagonal.xx - far.xx * squared, diagonal.xy - far.xy * squared,
                            diagonal.xz - far.xz * squared, diagonal.yy - far.yy * squared,
                            diagonal.yz - far.yz * squared, diagonal.zz - far.zz * squared};
                right = right - (far * system.right[p - 2]) * second;
            }
            M3 lower{zero3(), zero3(), zero3()};
            if (p > first) {
                lower = multiply(coupling, system.inverse[p - 1]);
                diagonal = {diagonal.xx - dot(lower.x, coupling.x), diagonal.xy - dot(lower.x, coupling.y),
                            diagonal.xz - dot(lower.x, coupling.z), diagonal.yy - dot(lower.y, coupling.y),
                            diagonal.yz - dot(lower.y, coupling.z), diagonal.zz - dot(lower.z, coupling.z)};
                right = right - lower * system.right[p - 1];
            }
            system.inverse[p] = inverseOf(diagonal);
            system.lower[p] = lower;
            system.second[p] = second;
            system.right[p] = right;
            inner = outer;
        }
        V3 next1 = zero3(), next2 = zero3();
        for (std::uint32_t p = block.points; p-- > first;) {
            V3 rate = system.inverse[p] * system.right[p];
            if (p + 1 < block.points) rate = rate - transposedTimes(system.lower[p + 1], next1);
            if (p + 2 < block.points) rate = rate - (system.inverse[p] * next2) * system.second[p + 2];
            finishImplicit(block, std::size_t{p} * kBlockLanes + lane, rate);
            next2 = next1;
            next1 = rate;
        }
    }
    finishClamped(block);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
