// SPDX-License-Identifier: MIT
// Vectors of doubles, for what is prepared before strands move: nothing is fused, so that every instruction
// set rounds alike.
#if defined(HAIRLOOM_RUNTIME_ROD_REST_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_REST_MATH_INL_H
#undef HAIRLOOM_RUNTIME_ROD_REST_MATH_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_REST_MATH_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/kernels.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {
namespace at_rest {

#if HWY_HAVE_FLOAT64
namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using R = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
inline constexpr std::size_t kWide = hn::MaxLanes(Tag());

HWY_INLINE R num(double value) {
    return hn::Set(Tag(), value);
}
HWY_INLINE R load(const float* at) {
    return hn::PromoteTo(Tag(), hn::Load(hn::Rebind<float, Tag>(), at));
}
HWY_INLINE void store(R value, float* at) {
    const hn::Rebind<float, Tag> floats;
    hn::Store(hn::DemoteTo(floats, value), floats, at);
}
HWY_INLINE R loadLanes(const double* at) {
    return hn::LoadU(Tag(), at);
}
HWY_INLINE void storeLanes(R value, double* at) {
    hn::StoreU(value, Tag(), at);
}
HWY_INLINE R root(R a) {
    return hn::Sqrt(a);
}
HWY_INLINE R lesser(R a, R b) {
    return hn::Min(a, b);
}
HWY_INLINE R greater(R a, R b) {
    return hn::Max(a, b);
}
HWY_INLINE Mask above(R a, R b) {
    return hn::Gt(a, b);
}
HWY_INLINE Mask equal(R a, R b) {
    return hn::Eq(a, b);
}
HWY_INLINE R choose(Mask which, R yes, R no) {
    return hn::IfThenElse(which, yes, no);
}
HWY_INLINE Mask both(Mask a, Mask b) {
    return hn::And(a, b);
}
HWY_INLINE Mask butNot(Mask a, Mask without) {
    return hn::AndNot(without, a);
}
HWY_INLINE bool any(Mask which) {
    return !hn::AllFalse(Tag(), which);
}
#else  // one strand at a time
using R = double;
using Mask = bool;
inline constexpr std::size_t kWide = 1;

HWY_INLINE R num(double value) {
    return value;
}
HWY_INLINE R load(const float* at) {
    return static_cast<double>(*at);
}
HWY_INLINE void store(R value, float* at) {
    *at = static_cast<float>(value);
}
HWY_INLINE R loadLanes(const double* at) {
    return *at;
}
HWY_INLINE void storeLanes(R value, double* at) {
    *at = value;
}
HWY_INLINE R root(R a) {
    return std::sqrt(a);
}
HWY_INLINE R lesser(R a, R b) {
    return std::min(a, b);
}
HWY_INLINE R greater(R a, R b) {
    return std::max(a, b);
}
HWY_INLINE Mask above(R a, R b) {
    return a > b;
}
HWY_INLINE Mask equal(R a, R b) {
    return a == b;
}
HWY_INLINE R choose(Mask which, R yes, R no) {
    return which ? yes : no;
}
HWY_INLINE Mask both(Mask a, Mask b) {
    return a && b;
}
HWY_INLINE Mask butNot(Mask a, Mask without) {
    return a && !without;
}
HWY_INLINE bool any(Mask which) {
    return which;
}
#endif
static_assert(kBlockLanes % kWide == 0);

struct R3 {
    R x, y, z;
};
HWY_INLINE R3 zero3() {
    return {num(0.0), num(0.0), num(0.0)};
}
HWY_INLINE R3 operator+(R3 a, R3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE R3 operator-(R3 a, R3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE R3 operator*(R3 a, R s) {
    return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE R dot(R3 a, R3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE R3 cross(R3 a, R3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE R lengthOf(R3 a) {
    return root(dot(a, a));
}
HWY_INLINE R3 choose(Mask which, R3 yes, R3 no) {
    return {choose(which, yes.x, no.x), choose(which, yes.y, no.y), choose(which, yes.z, no.z)};
}
/// A segment's tangent in its frame.
HWY_INLINE R3 along() {
    return {num(0.0), num(0.0), num(1.0)};
}

/// A rotation as a unit quaternion.
struct Turn {
    R3 v;
    R w;
};
HWY_INLINE Turn noTurn() {
    return {zero3(), num(1.0)};
}
HWY_INLINE Turn normalized(Turn q) {
    const R scale = num(1.0) / root(dot(q.v, q.v) + q.w * q.w);
    return {q.v * scale, q.w * scale};
}
HWY_INLINE Turn operator*(Turn a, Turn b) {
    return {b.v * a.w + a.v * b.w + cross(a.v, b.v), a.w * b.w - dot(a.v, b.v)};
}
HWY_INLINE Turn inverse(Turn q) {
    return {q.v * num(-1.0), q.w};
}
HWY_INLINE Turn choose(Mask which, Turn yes, Turn no) {
    return {choose(which, yes.v, no.v), choose(which, yes.w, no.w)};
}
HWY_INLINE R3 rotate(Turn q, R3 v) {
    const R3 twice = cross(q.v, v) * num(2.0);
    return v + twice * q.w + cross(q.v, twice);
}
/// along(), turned.
HWY_INLINE R3 alongOf(Turn q) {
    const R two = num(2.0);
    return {two * (q.v.x * q.v.z + q.w * q.v.y), two * (q.v.y * q.v.z - q.w * q.v.x),
            num(1.0) - two * (q.v.x * q.v.x + q.v.y * q.v.y)};
}
/// X, or Y where X is nearly along a unit vector.
HWY_INLINE R3 besides(R3 a) {
    const Mask far = above(num(0.64), a.x * a.x);
    return {choose(far, num(1.0), num(0.0)), choose(far, num(0.0), num(1.0)), num(0.0)};
}
/// The least rotation that takes one unit vector to another.
HWY_INLINE Turn between(R3 a, R3 b) {
    const R c = dot(a, b);
    const Mask near = above(c, num(-0.999999));
    return normalized(
        {choose(near, cross(a, b), cross(a, besides(a))), choose(near, num(1.0) + c, num(0.0))});
}
/// The part of a direction across a unit axis, of unit length.
HWY_INLINE R3 across(R3 direction, R3 axis) {
    R3 part = direction - axis * dot(direction, axis);
    part = choose(above(lengthOf(part), num(1e-6)), part, cross(axis, besides(axis)));
    return part * (num(1.0) / lengthOf(part));
}

/// A symmetric matrix.
struct Symmetric {
    R xx, xy, xz, yy, yz, zz;

    HWY_INLINE void addDiagonal(R a) {
        xx = xx + a;
        yy = yy + a;
        zz = zz + a;
    }
    /// a aᵀ s.
    HWY_INLINE void addSquare(R3 a, R s) {
        const R3 b = a * s;
        xx = xx + a.x * b.x;
        xy = xy + a.x * b.y;
        xz = xz + a.x * b.z;
        yy = yy + a.y * b.y;
        yz = yz + a.y * b.z;
        zz = zz + a.z * b.z;
    }
    /// a bᵀ + b aᵀ.
    HWY_INLINE void addBoth(R3 a, R3 b) {
        xx = xx + num(2.0) * a.x * b.x;
        xy = xy + (a.x * b.y + a.y * b.x);
        xz = xz + (a.x * b.z + a.z * b.x);
        yy = yy + num(2.0) * a.y * b.y;
        yz = yz + (a.y * b.z + a.z * b.y);
        zz = zz + num(2.0) * a.z * b.z;
    }
    /// Takes Rᵀ `sum`⁻¹ R off, where R is this matrix less [couple]ₓ. Where `sum` is positive definite.
    HWY_INLINE Mask eliminate(const Symmetric& sum, R3 couple) {
        const R one = num(1.0), none = num(0.0);
        const R d0 = sum.xx, i0 = one / d0;
        const R l10 = sum.xy * i0, l20 = sum.xz * i0;
        const R d1 = sum.yy - l10 * sum.xy, i1 = one / d1;
        const R s21 = sum.yz - l20 * sum.xy;
        const R l21 = s21 * i1;
        const R d2 = sum.zz - l20 * sum.xz - l21 * s21;
        const R3 y0{xx, xy + couple.z, xz - couple.y};
        const R3 y1 = R3{xy - couple.z, yy, yz + couple.x} - y0 * l10;
        const R3 y2 = R3{xz + couple.y, yz - couple.x, zz} - y0 * l20 - y1 * l21;
        addSquare(y0, none - i0);
        addSquare(y1, none - i1);
        addSquare(y2, none - one / d2);
        return both(above(d0, none), both(above(d1, none), above(d2, none)));
    }
};
HWY_INLINE Symmetric noMatrix() {
    const R none = num(0.0);
    return {none, none, none, none, none, none};
}

}  // namespace at_rest
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
