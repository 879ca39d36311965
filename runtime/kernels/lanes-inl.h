// SPDX-License-Identifier: MIT
// Vectors of lanes: three- and four-component arithmetic on Highway registers. Included anew for each
// instruction set.
#if defined(HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#undef HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#else
#define HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
inline constexpr std::size_t kWidth = hn::MaxLanes(D());
static_assert(kBlockLanes % kWidth == 0);

/// Floats of a scratch plane: a slot for each point of a block, and a cache line that keeps planes off each
/// other's 4 KiB aliases.
inline constexpr std::size_t kScratchPlane = std::size_t{kMaxPoints} * kBlockLanes + 16;

struct V3 {
    V x, y, z;
};
struct V4 {
    V x, y, z, w;
};

HWY_INLINE V all(float value) {
    return hn::Set(D(), value);
}
HWY_INLINE V3 all3(Float3 v) {
    return {all(v.x), all(v.y), all(v.z)};
}
HWY_INLINE V3 zero3() {
    return {hn::Zero(D()), hn::Zero(D()), hn::Zero(D())};
}

HWY_INLINE V3 load3(const Planes& p, std::size_t i) {
    return {hn::Load(D(), p.x + i), hn::Load(D(), p.y + i), hn::Load(D(), p.z + i)};
}
HWY_INLINE V3 load3(const ConstPlanes& p, std::size_t i) {
    return {hn::Load(D(), p.x + i), hn::Load(D(), p.y + i), hn::Load(D(), p.z + i)};
}
HWY_INLINE V3 load3(const float (*p)[kBlockLanes], std::size_t i) {
    return {hn::Load(D(), p[0] + i), hn::Load(D(), p[1] + i), hn::Load(D(), p[2] + i)};
}
HWY_INLINE V4 load4(const float (*p)[kBlockLanes], std::size_t i) {
    return {hn::Load(D(), p[0] + i), hn::Load(D(), p[1] + i), hn::Load(D(), p[2] + i),
            hn::Load(D(), p[3] + i)};
}
HWY_INLINE void store3(V3 v, const Planes& p, std::size_t i) {
    hn::Store(v.x, D(), p.x + i);
    hn::Store(v.y, D(), p.y + i);
    hn::Store(v.z, D(), p.z + i);
}
HWY_INLINE void store3(V3 v, float (*p)[kBlockLanes], std::size_t i) {
    store3(v, Planes{p[0], p[1], p[2]}, i);
}
HWY_INLINE void store4(V4 v, float (*p)[kBlockLanes], std::size_t i) {
    store3({v.x, v.y, v.z}, p, i);
    hn::Store(v.w, D(), p[3] + i);
}

HWY_INLINE V3 operator+(V3 a, V3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE V3 operator-(V3 a, V3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE V3 operator*(V3 a, V s) {
    return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE V lerp(V a, V b, V t) {
    return a + (b - a) * t;
}
HWY_INLINE V dot(V3 a, V3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE V3 cross(V3 a, V3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE V3 select(hn::Mask<D> which, V3 yes, V3 no) {
    return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y),
            hn::IfThenElse(which, yes.z, no.z)};
}

HWY_INLINE V3 rotate(V4 q, V3 v) {
    const V3 axis{q.x, q.y, q.z};
    const V3 half = cross(axis, v);
    const V3 twice = half + half;
    return v + twice * q.w + cross(axis, twice);
}
/// First b, then a.
HWY_INLINE V4 multiply(V4 a, V4 b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// sin(2π·turns) to 0.1 %: a parabola, refined once by its own square.
HWY_INLINE V sineOfTurns(V turns) {
    const V part = turns - hn::Round(turns);
    const V parabola = all(16.0f) * part * (all(0.5f) - hn::Abs(part));
    return all(0.775f) * parabola + all(0.225f) * parabola * hn::Abs(parabola);
}

HWY_INLINE float laneLeast(V v) {
    return hn::GetLane(hn::MinOfLanes(D(), v));
}
HWY_INLINE float laneMost(V v) {
    return hn::GetLane(hn::MaxOfLanes(D(), v));
}

struct Box {
    Float3 low, high;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
