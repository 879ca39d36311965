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

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// 1/√x to 6e-7 of it, for x of 1e-37 and more: a first guess from the bits (Lomont 2003) and two Newton
/// steps. A step leaves its error on one side, so each is scaled to leave half of it on both. Dividers are
/// many times slower, and this rounds the same on all instruction sets.
HWY_INLINE V inverseSqrt(V x) {
    constexpr float kFirst = 1.0f + 8.756e-4f, kSecond = 1.0f + 5.75e-7f;
    const hn::RebindToSigned<D> di;
    V y = hn::BitCast(D(), hn::Set(di, 0x5f375a86) - hn::ShiftRight<1>(hn::BitCast(di, x)));
    y = y * (all(1.5f * kFirst) - x * all(0.5f * kFirst) * y * y);
    return y * (all(1.5f * kSecond) - x * all(0.5f * kSecond) * y * y);
}

struct Direction {
    V3 unit;
    V length;
};

/// Of an offset from a sphere's centre; at the very centre it points up.
HWY_INLINE Direction directionOf(V3 offset) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V squared = dot(offset, offset);
    const auto centred = squared < all(1e-18f);
    const V inverse = inverseSqrt(hn::IfThenElse(centred, one, squared));
    return {
        {hn::IfThenElse(centred, zero, offset.x * inverse), hn::IfThenElse(centred, one, offset.y * inverse),
         hn::IfThenElse(centred, zero, offset.z * inverse)},
        squared * inverse};
}

/// Pearl radius at each point, growing linearly to the tip.
HWY_INLINE void fillPearls(const BlockView& block, const SubstepContext& context, float* pearls) {
    const float slope = (context.pearlTip - context.pearlRoot) / static_cast<float>(block.points - 1);
    for (std::uint32_t p = 0; p < block.points; ++p) {
        pearls[p] = context.pearlRoot + slope * static_cast<float>(p);
    }
}

/// Spheres where they are in one substep, as arrays, so that one vector of them is tested against a box at
/// once.
class SphereSet {
  public:
    static constexpr std::size_t kMost = 64;
    float radius[kMost];  ///< metres
    float widest[kMost];  ///< with the largest pearl

    HWY_INLINE void take(std::span<const MovingSphere> spheres, float step, float largestPearl) {
        count_ = spheres.size();
        for (std::size_t k = 0; k < count_; ++k) {
            const Float3 centre = spheres[k].from_ws + spheres[k].step * step;
            x_[k] = centre.x;
            y_[k] = centre.y;
            z_[k] = centre.z;
            radius[k] = spheres[k].radius;
            widest[k] = spheres[k].radius + largestPearl;
        }
        for (std::size_t k = count_; k % kWidth != 0; ++k) {
            x_[k] = y_[k] = z_[k] = 1e18f;
            widest[k] = 0.0f;
        }
    }

    /// World.
    HWY_INLINE V3 centre(std::size_t k) const { return all3({x_[k], y_[k], z_[k]}); }

    /// Calls visit(k) for each sphere that, with the largest pearl, meets the box; in ascending order.
    template <class Visit>
    HWY_INLINE void forEachMeeting(const Box& box, Visit&& visit) const {
        const V zero = hn::Zero(D());
        for (std::size_t k = 0; k < count_; k += kWidth) {
            const V x = hn::Load(D(), x_ + k), y = hn::Load(D(), y_ + k), z = hn::Load(D(), z_ + k);
            const V3 gap{hn::Max(hn::Max(all(box.low.x) - x, x - all(box.high.x)), zero),
                         hn::Max(hn::Max(all(box.low.y) - y, y - all(box.high.y)), zero),
                         hn::Max(hn::Max(all(box.low.z) - z, z - all(box.high.z)), zero)};
            const V reach = hn::Load(D(), widest + k);
            forEachSet(k, dot(gap, gap) <= reach * reach * all(1.0001f), visit);
        }
    }

    /// The spheres in which a point on sphere k can be, as bits.
    HWY_INLINE std::uint64_t overlapping(std::size_t k) const {
        static_assert(kMost <= 64);
        const V3 at = centre(k);
        const V own = all(widest[k]);
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
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(D(), which, bytes);
        std::uint32_t bits = bytes[0] | (std::uint32_t{bytes[1]} << 8);
        bits &= (1u << kWidth) - 1u;
        for (; bits != 0; bits &= bits - 1) {
            const std::size_t k = first + static_cast<std::size_t>(std::countr_zero(bits));
            if (k < count_) visit(k);
        }
    }

    alignas(64) float x_[kMost], y_[kMost], z_[kMost];
    std::size_t count_ = 0;
};

/// A box per lane.
struct WideBox {
    V3 low, high;

    static HWY_INLINE WideBox empty() {
        return {all3({1e30f, 1e30f, 1e30f}), all3({-1e30f, -1e30f, -1e30f})};
    }

    HWY_INLINE void add(V3 least, V3 most) {
        low = {hn::Min(low.x, least.x), hn::Min(low.y, least.y), hn::Min(low.z, least.z)};
        high = {hn::Max(high.x, most.x), hn::Max(high.y, most.y), hn::Max(high.z, most.z)};
    }
    HWY_INLINE void add(const WideBox& other, V3 shift) { add(other.low + shift, other.high + shift); }
    /// Around those of all lanes.
    HWY_INLINE Box reduced() const {
        return {{laneLeast(low.x), laneLeast(low.y), laneLeast(low.z)},
                {laneMost(high.x), laneMost(high.y), laneMost(high.z)}};
    }
};

/// Boxes of pieces of a few points, of each strand of a strip its own; relative to the roots.
class PieceBoxes {
  public:
    static constexpr std::uint32_t kPoints = 5;
    static constexpr std::uint32_t kMostPoints = 16;  ///< of one strand at a time
    static constexpr std::uint32_t kMost = (kMostPoints + kPoints - 1) / kPoints;
    std::uint32_t count = 0;

    /// Fills the boxes of points first … last − 1; the boxes of all of them.
    HWY_INLINE WideBox take(const BlockView& block, std::uint32_t lane, std::uint32_t first,
                            std::uint32_t last) {
        WideBox whole = WideBox::empty();
        count = 0;
        for (std::uint32_t begin = first; begin < last; begin += kPoints) {
            const std::uint32_t end = std::min(begin + kPoints, last);
            WideBox piece = WideBox::empty();
            for (std::uint32_t p = begin; p < end; ++p) {
                const V3 at = load3(block.position, std::size_t{p} * kBlockLanes + lane);
                piece.add(at, at);
            }
            storePiece(piece.low, low_[count]);
            storePiece(piece.high, high_[count]);
            ++count;
            whole.add(piece.low, piece.high);
        }
        return whole;
    }

    HWY_INLINE V squaredGap(std::uint32_t piece, V3 at) const {
        const V zero = hn::Zero(D());
        const V3 low = loadPiece(low_[piece]), high = loadPiece(high_[piece]);
        const V3 gap{hn::Max(hn::Max(low.x - at.x, at.x - high.x), zero),
                     hn::Max(hn::Max(low.y - at.y, at.y - high.y), zero),
                     hn::Max(hn::Max(low.z - at.z, at.z - high.z), zero)};
        return dot(gap, gap);
    }

  private:
    using Piece = float[3][kWidth];

    static HWY_INLINE V3 loadPiece(const Piece& piece) {
        return {hn::Load(D(), piece[0]), hn::Load(D(), piece[1]), hn::Load(D(), piece[2])};
    }
    static HWY_INLINE void storePiece(V3 v, Piece& piece) {
        hn::Store(v.x, D(), piece[0]);
        hn::Store(v.y, D(), piece[1]);
        hn::Store(v.z, D(), piece[2]);
    }

    alignas(64) Piece low_[kMost];
    alignas(64) Piece high_[kMost];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
