// SPDX-License-Identifier: MIT
// Vectors of lanes: three- and four-component arithmetic on Highway registers. Included anew for each
// instruction set.
#if defined(HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#undef HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#else
#define HAIRLOOM_RUNTIME_KERNELS_LANES_INL_H
#endif

#include <cmath>

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

/// The shortest rotation from one direction to another (Melax 2000), for vectors of any length. Opposite
/// vectors turn by 180° about an axis across them; a vector without length turns nothing.
HWY_INLINE V4 shortestArc(V3 from, V3 to) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V sizes = hn::Sqrt(dot(from, from) * dot(to, to));
    const V3 across = cross(from, to);
    const V sum = sizes + dot(from, to);
    // The squared length of (across, sum) is 2 · sizes · sum.
    const V inverse = one / hn::Sqrt((sizes + sizes) * sum);
    const V4 arc{across.x * inverse, across.y * inverse, across.z * inverse, sum * inverse};
    const auto opposite = sum <= sizes * all(1e-6f);
    if (HWY_LIKELY(hn::AllFalse(D(), opposite))) return arc;

    const auto nothing = sizes < all(1e-30f);
    const auto alongX = hn::Abs(from.x) > hn::Abs(from.z);
    const V3 axis{hn::IfThenElse(alongX, zero - from.y, zero), hn::IfThenElse(alongX, from.x, zero - from.z),
                  hn::IfThenElse(alongX, zero, from.y)};
    const V norm = hn::Sqrt(dot(axis, axis));
    const auto flat = norm < all(1e-20f);  // only where `from` lies along y, or has no length
    const V scale = one / hn::IfThenElse(flat, one, norm);
    const V3 turn = select(flat, {one, zero, zero}, axis * scale);
    const V3 bits = select(nothing, zero3(), turn);
    return {hn::IfThenElse(opposite, bits.x, arc.x), hn::IfThenElse(opposite, bits.y, arc.y),
            hn::IfThenElse(opposite, bits.z, arc.z),
            hn::IfThenElse(opposite, hn::IfThenElse(nothing, one, zero), arc.w)};
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

    bool meets(Float3 centre, float radius) const {
        const Float3 gap{std::fmax(std::fmax(low.x - centre.x, centre.x - high.x), 0.0f),
                         std::fmax(std::fmax(low.y - centre.y, centre.y - high.y), 0.0f),
                         std::fmax(std::fmax(low.z - centre.z, centre.z - high.z), 0.0f)};
        return runtime::dot(gap, gap) <= radius * radius * 1.0001f;
    }
};

/// World box of a block's free points after `step` substeps of the frame.
HWY_INLINE Box boundsOf(const BlockView& block, const LaneFrame& lanes, float step) {
    V3 low = all3({1e30f, 1e30f, 1e30f}), high = all3({-1e30f, -1e30f, -1e30f});
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 least = all3({1e30f, 1e30f, 1e30f}), most = all3({-1e30f, -1e30f, -1e30f});
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const V3 at = load3(block.position, std::size_t{p} * kBlockLanes + lane);
            least = {hn::Min(least.x, at.x), hn::Min(least.y, at.y), hn::Min(least.z, at.z)};
            most = {hn::Max(most.x, at.x), hn::Max(most.y, at.y), hn::Max(most.z, at.z)};
        }
        const V3 root = load3(lanes.root, lane) + load3(lanes.rootStep, lane) * all(step);
        least = least + root;
        most = most + root;
        low = {hn::Min(low.x, least.x), hn::Min(low.y, least.y), hn::Min(low.z, least.z)};
        high = {hn::Max(high.x, most.x), hn::Max(high.y, most.y), hn::Max(high.z, most.z)};
    }
    return {{laneLeast(low.x), laneLeast(low.y), laneLeast(low.z)},
            {laneMost(high.x), laneMost(high.y), laneMost(high.z)}};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
