// SPDX-License-Identifier: MIT
// Which spheres a strip of strands can touch.
#if defined(HAIRLOOM_RUNTIME_SPHERES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_SPHERES_INL_H
#undef HAIRLOOM_RUNTIME_SPHERES_INL_H
#else
#define HAIRLOOM_RUNTIME_SPHERES_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "engine/real-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Of a positive x.
HWY_INLINE V inverseSqrt(V x) {
    return all(1.0f) / hn::Sqrt(x);
}

/// Where a vector points: from · inverse has unit length.
struct Direction {
    V3 from;
    V inverse, length;
};

/// Of an offset from a sphere's centre; at the very centre it points up.
HWY_INLINE Direction directionOf(V3 offset) {
    const V squared = dot(offset, offset);
    // Selecting each part costs three times as much.
    const V centred = hn::IfThenElseZero(squared < all(1e-18f), all(1.0f));
    const V inverse = inverseSqrt(squared + centred);
    return {{offset.x, offset.y + centred, offset.z}, inverse, squared * inverse};
}

/// The part of a point's offset from a sphere's centre across the segment before it; any direction across,
/// where there is none. Along their strand its own length would hold them back.
HWY_INLINE V3 acrossStrand(V3 offset, V3 edge) {
    const V zero = hn::Zero(D()), tiny = all(1e-18f);
    const V squared = dot(edge, edge);
    const V3 across = offset - edge * (dot(offset, edge) / hn::Max(squared, tiny));
    const V3 level{edge.z, zero, zero - edge.x};
    const auto upright = dot(level, level) <= squared * all(1e-6f);
    const V3 other = select(upright, {edge.y, zero, zero}, level);
    const auto centred = dot(across, across) <= squared * all(1e-8f);
    return select(squared > tiny, select(centred, other, across), offset);
}

/// A capsule for each lane, world, so many substeps after the start of the frame.
HWY_INLINE RodCapsule capsuleOf(const MovingCapsule& capsule, float substeps) {
    const auto& [first, second] = capsule.ends;
    const Float3 from = first.from_ws + first.step * substeps;
    return {all3(from),
            all3(second.from_ws + second.step * substeps - from),
            all3(first.step),
            all3(second.step - first.step),
            all(first.radius),
            all(first.radius - second.radius),
            all(std::min(first.radius, second.radius))};
}

/// Collision radius at each point ("pearls" in the thesis), growing linearly to the tip.
HWY_INLINE void fillCollisionRadii(const BlockView& block, const SubstepContext& context,
                                   float* collisionRadii) {
    const float slope =
        (context.collisionRadiusAtTip - context.collisionRadiusAtRoot) / static_cast<float>(block.points - 1);
    for (std::uint32_t p = 0; p < block.points; ++p) {
        collisionRadii[p] = context.collisionRadiusAtRoot + slope * static_cast<float>(p);
    }
}

/// Spheres where they are in one substep, as arrays, so that one vector of them is tested against a box at
/// once.
class SphereSet {
  public:
    static constexpr std::size_t kMax = 64;
    float radius[kMax];  ///< metres
    float widest[kMax];  ///< with the largest collision radius

    HWY_INLINE void take(std::span<const MovingSphere> spheres, float step, float maxCollisionRadius) {
        count_ = spheres.size();
        for (std::size_t k = 0; k < count_; ++k) {
            const Float3 centre = spheres[k].from_ws + spheres[k].step * step;
            x_[k] = centre.x;
            y_[k] = centre.y;
            z_[k] = centre.z;
            radius[k] = spheres[k].radius;
            widest[k] = spheres[k].radius + maxCollisionRadius;
        }
        for (std::size_t k = count_; k % kWidth != 0; ++k) {
            x_[k] = y_[k] = z_[k] = 1e18f;
            widest[k] = 0.0f;
        }
    }

    /// World.
    HWY_INLINE V3 centre(std::size_t k) const { return all3({x_[k], y_[k], z_[k]}); }

    /// Calls visit(k) for each sphere that, with the largest collision radius and the margin around it, meets
    /// the box; in ascending order.
    template <class Visit>
    HWY_INLINE void forEachMeeting(const Box& box, float margin, Visit&& visit) const {
        const V zero = hn::Zero(D());
        for (std::size_t k = 0; k < count_; k += kWidth) {
            const V x = hn::Load(D(), x_ + k), y = hn::Load(D(), y_ + k), z = hn::Load(D(), z_ + k);
            const V3 gap{hn::Max(hn::Max(all(box.low.x) - x, x - all(box.high.x)), zero),
                         hn::Max(hn::Max(all(box.low.y) - y, y - all(box.high.y)), zero),
                         hn::Max(hn::Max(all(box.low.z) - z, z - all(box.high.z)), zero)};
            const V reach = hn::Load(D(), widest + k) + all(margin);
            forEachSet(k, dot(gap, gap) <= reach * reach * all(1.0001f), visit);
        }
    }

    std::size_t count() const { return count_; }

    /// The spheres in which a point on sphere k can be, as bits, until two of them have come nearer by
    /// `margin`.
    HWY_INLINE std::uint64_t overlapping(std::size_t k, float margin) const {
        static_assert(kMax <= 64);
        const V3 at = centre(k);
        const V own = all(widest[k] + margin);
        std::uint64_t others = 0;
        for (std::size_t j = 0; j < count_; j += kWidth) {
            const V3 gap = V3{hn::Load(D(), x_ + j), hn::Load(D(), y_ + j), hn::Load(D(), z_ + j)} - at;
            const V reach = hn::Load(D(), widest + j) + own;
            forEachSet(j, dot(gap, gap) < reach * reach, [&](std::size_t other) HWY_ATTR {
                if (other != k) others |= std::uint64_t{1} << other;
            });
        }
        return others;
    }

  private:
    template <class Visit>
    HWY_INLINE void forEachSet(std::size_t first, hn::Mask<D> which, Visit&& visit) const {
        for (std::uint32_t bits = bitsOf(which); bits != 0; bits &= bits - 1) {
            const std::size_t k = first + static_cast<std::size_t>(std::countr_zero(bits));
            if (k < count_) visit(k);
        }
    }

    alignas(64) float x_[kMax], y_[kMax], z_[kMax];
    std::size_t count_ = 0;
};

/// A box per lane.
struct WideBox {
    V3 low, high;

    static HWY_INLINE WideBox empty() {
        return {all3({1e30f, 1e30f, 1e30f}), all3({-1e30f, -1e30f, -1e30f})};
    }

    HWY_INLINE void add(V3 minimum, V3 maximum) {
        low = {hn::Min(low.x, minimum.x), hn::Min(low.y, minimum.y), hn::Min(low.z, minimum.z)};
        high = {hn::Max(high.x, maximum.x), hn::Max(high.y, maximum.y), hn::Max(high.z, maximum.z)};
    }
    HWY_INLINE void add(const WideBox& other, V3 shift) { add(other.low + shift, other.high + shift); }
    /// Around those of all lanes.
    HWY_INLINE Box reduced() const {
        return {{laneMin(low.x), laneMin(low.y), laneMin(low.z)},
                {laneMax(high.x), laneMax(high.y), laneMax(high.z)}};
    }
};

/// Of points first … last − 1 of each strand of a strip, relative to the roots.
HWY_INLINE WideBox boxOf(const BlockView& block, std::uint32_t lane, std::uint32_t first,
                         std::uint32_t last) {
    WideBox box = WideBox::empty();
    for (std::uint32_t p = first; p < last; ++p) {
        const V3 at = load3(block.position, std::size_t{p} * kBlockLanes + lane);
        box.add(at, at);
    }
    return box;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
