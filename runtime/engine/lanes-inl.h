// SPDX-License-Identifier: MIT
// Vectors of lanes: three- and four-component arithmetic on Highway registers. Included anew for each
// instruction set.
#if defined(HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#undef HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#else
#define HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#endif

#include "engine/kernels.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWidestVector>;
using V = hn::Vec<D>;
inline constexpr std::size_t kWidth = hn::MaxLanes(D());
static_assert(kBlockLanes % kWidestVector == 0 && kWidestVector % kWidth == 0);

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

template <class Float>
HWY_INLINE V3 load3(const PlanesOf<Float>& p, std::size_t i) {
    const Float* const at = p.x + i;
    return {hn::Load(D(), at), hn::Load(D(), at + p.pitch), hn::Load(D(), at + 2 * p.pitch)};
}
HWY_INLINE V3 load3(const float (*p)[kBlockLanes], std::size_t i) {
    return {hn::Load(D(), p[0] + i), hn::Load(D(), p[1] + i), hn::Load(D(), p[2] + i)};
}
HWY_INLINE V3 load3(const float* at, std::size_t pitch) {
    return {hn::Load(D(), at), hn::Load(D(), at + pitch), hn::Load(D(), at + 2 * pitch)};
}
HWY_INLINE V4 load4(const float (*p)[kBlockLanes], std::size_t i) {
    return {hn::Load(D(), p[0] + i), hn::Load(D(), p[1] + i), hn::Load(D(), p[2] + i),
            hn::Load(D(), p[3] + i)};
}
HWY_INLINE void store3(V3 v, const Planes& p, std::size_t i) {
    float* const at = p.x + i;
    hn::Store(v.x, D(), at);
    hn::Store(v.y, D(), at + p.pitch);
    hn::Store(v.z, D(), at + 2 * p.pitch);
}
HWY_INLINE void store3(V3 v, float* at, std::size_t pitch) {
    hn::Store(v.x, D(), at);
    hn::Store(v.y, D(), at + pitch);
    hn::Store(v.z, D(), at + 2 * pitch);
}
HWY_INLINE void store3(V3 v, float (*p)[kBlockLanes], std::size_t i) {
    hn::Store(v.x, D(), p[0] + i);
    hn::Store(v.y, D(), p[1] + i);
    hn::Store(v.z, D(), p[2] + i);
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
/// a · s + b.
HWY_INLINE V3 mulAdd(V3 a, V s, V3 b) {
    return {hn::MulAdd(a.x, s, b.x), hn::MulAdd(a.y, s, b.y), hn::MulAdd(a.z, s, b.z)};
}
/// a · s − b.
HWY_INLINE V3 mulSub(V3 a, V s, V3 b) {
    return {hn::MulSub(a.x, s, b.x), hn::MulSub(a.y, s, b.y), hn::MulSub(a.z, s, b.z)};
}
/// b − a · s.
HWY_INLINE V3 negMulAdd(V3 a, V s, V3 b) {
    return {hn::NegMulAdd(a.x, s, b.x), hn::NegMulAdd(a.y, s, b.y), hn::NegMulAdd(a.z, s, b.z)};
}
HWY_INLINE V lerp(V a, V b, V t) {
    return hn::MulAdd(b - a, t, a);
}
HWY_INLINE V dot(V3 a, V3 b) {
    return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, a.x * b.x));
}
HWY_INLINE V3 cross(V3 a, V3 b) {
    return {hn::NegMulAdd(a.z, b.y, a.y * b.z), hn::NegMulAdd(a.x, b.z, a.z * b.x),
            hn::NegMulAdd(a.y, b.x, a.x * b.y)};
}
HWY_INLINE V3 select(hn::Mask<D> which, V3 yes, V3 no) {
    return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y),
            hn::IfThenElse(which, yes.z, no.z)};
}

HWY_INLINE V3 rotate(V4 q, V3 v) {
    const V3 axis{q.x, q.y, q.z};
    const V3 half = cross(axis, v);
    const V3 twice = half + half;
    return mulAdd(twice, q.w, v) + cross(axis, twice);
}
/// Rows.
struct M3 {
    V3 x, y, z;
};

/// Zero in the other lanes.
HWY_INLINE V3 onlyWhere(hn::Mask<D> which, V3 v) {
    return {hn::IfThenElseZero(which, v.x), hn::IfThenElseZero(which, v.y), hn::IfThenElseZero(which, v.z)};
}
HWY_INLINE hn::Mask<D> noLane() {
    return hn::FirstN(D(), 0);
}

/// A bit for each lane.
HWY_INLINE std::uint32_t bitsOf(hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), mask, bytes);
    return (bytes[0] | (std::uint32_t{bytes[1]} << 8)) & ((1u << kWidth) - 1u);
}
HWY_INLINE hn::Mask<D> maskOf(std::uint32_t bits) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(D(), bytes);
}

/// sin(2π·turns) to 0.1 %: a parabola, refined once by its own square.
HWY_INLINE V sineOfTurns(V turns) {
    const V part = turns - hn::Round(turns);
    const V parabola = all(16.0f) * part * (all(0.5f) - hn::Abs(part));
    return all(0.775f) * parabola + all(0.225f) * parabola * hn::Abs(parabola);
}

HWY_INLINE float laneMin(V v) {
    return hn::GetLane(hn::MinOfLanes(D(), v));
}
HWY_INLINE float laneMax(V v) {
    return hn::GetLane(hn::MaxOfLanes(D(), v));
}

/// The most of valueAt(i), 0 or more, of all free points.
template <class ValueAt>
HWY_INLINE float maxOfBlock(const BlockView& block, ValueAt&& valueAt) {
    V ofAll = hn::Zero(D());
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        // A maximum waits for the one before it: those of the strips need not.
        V maximum = hn::Zero(D());
        for (std::uint32_t p = block.firstFree; p < block.points; ++p)
            maximum = hn::Max(maximum, valueAt(std::size_t{p} * kBlockLanes + lane));
        ofAll = hn::Max(ofAll, maximum);
    }
    return laneMax(ofAll);
}

struct Box {
    Float3 low, high;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
