// SPDX-License-Identifier: MIT
// Names of numbers and of what is done to them, in which shaders/rod.h and its neighbours are written, for
// vectors of strands.
#if defined(HAIRLOOM_RUNTIME_REAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_REAL_INL_H
#undef HAIRLOOM_RUNTIME_REAL_INL_H
#else
#define HAIRLOOM_RUNTIME_REAL_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "shaders/rod_constants.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

using Real = V;
using Real3 = V3;
using Real4 = V4;
using RodMask = hn::Mask<D>;

HWY_INLINE V mad(V a, V b, V c) {
    return hn::MulAdd(a, b, c);
}
HWY_INLINE V negMad(V a, V b, V c) {
    return hn::NegMulAdd(a, b, c);
}
HWY_INLINE V3 mad3(V3 a, V s, V3 b) {
    return mulAdd(a, s, b);
}
HWY_INLINE V3 negMad3(V3 a, V s, V3 b) {
    return negMulAdd(a, s, b);
}
HWY_INLINE V maximum(V a, V b) {
    return hn::Max(a, b);
}
HWY_INLINE V minimum(V a, V b) {
    return hn::Min(a, b);
}
HWY_INLINE V absolute(V a) {
    return hn::Abs(a);
}
HWY_INLINE V root(V a) {
    return hn::Sqrt(a);
}
HWY_INLINE V3 xyz(V4 q) {
    return {q.x, q.y, q.z};
}
HWY_INLINE V3 real3(V x, V y, V z) {
    return {x, y, z};
}
HWY_INLINE V4 real4(V3 v, V w) {
    return {v.x, v.y, v.z, w};
}
HWY_INLINE V withSignOf(V v, V sign) {
    return hn::Xor(v, hn::And(sign, all(-0.0f)));
}
HWY_INLINE V3 withSignOf(V3 v, V sign) {
    const V negative = hn::And(sign, all(-0.0f));
    return {hn::Xor(v.x, negative), hn::Xor(v.y, negative), hn::Xor(v.z, negative)};
}

HWY_INLINE RodMask both(RodMask a, RodMask b) {
    return hn::And(a, b);
}
HWY_INLINE RodMask either(RodMask a, RodMask b) {
    return hn::Or(a, b);
}
HWY_INLINE V choose(RodMask which, V yes, V no) {
    return hn::IfThenElse(which, yes, no);
}
HWY_INLINE V3 choose(RodMask which, V3 yes, V3 no) {
    return select(which, yes, no);
}

#define ROD_FUNCTION HWY_INLINE
#define ROD_INOUT(Type) Type&
#define ROD_OUT(Type) Type&
#define ROD_UNROLL
#define ROD_NUMBER(value) all(static_cast<float>(value))
#undef HAIRLOOM_ROD_CAPSULE_FUNCTIONS
#include "shaders/rod_capsule.h"
#undef ROD_FUNCTION
#undef ROD_INOUT
#undef ROD_OUT
#undef ROD_UNROLL
#undef ROD_NUMBER

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
