// SPDX-License-Identifier: MIT
// Angular springs solved together along each strand (docs/engine.md), a strip of lanes at a time: what a
// strip works with stays in registers and the first-level cache.
#if defined(HAIRLOOM_RUNTIME_BEND_SOLVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_BEND_SOLVE_INL_H
#undef HAIRLOOM_RUNTIME_BEND_SOLVE_INL_H
#else
#define HAIRLOOM_RUNTIME_BEND_SOLVE_INL_H
#endif

#include <cmath>

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/bend-inl.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Seconds in which curves that lag arrive, and the speed in metres per second above which they wait.
inline constexpr float kLeakTime = 2.0f;
inline constexpr float kLeakSpeed = 0.0015f;

/// Cosine of the turn, 162°, behind which a frame's normal follows from rounding: joints there keep their
/// curves.
inline constexpr float kFold = -0.95f;

/// What the joints of a strip do in a substep before it is known how far their curves turn.
struct Turning {
    StripRow3 ahead;   ///< how far the tangent ahead of the joint is from the one behind it, q·moved on
    StripRow3 change;  ///< from the curve that it holds to that of today's frame
    V share;           ///< of `change` that it takes
};

/// A segment's directions at `previous`, and q of the way to `position` farther on; read root to tip.
class Directions {
  public:
    HWY_INLINE Directions(const BlockView& block, const SubstepContext& context, std::size_t lane)
        : block_(block), q_(all(context.bendRate)), from_(load3(block.previous, lane)) {
        moved_ = load3(block.position, lane) - from_;
        lane_ = lane;
    }

    V3 now, later;

    HWY_INLINE void read(std::uint32_t s) {
        const std::size_t i = std::size_t{s} * kBlockLanes + lane_;
        const V inverseLength = hn::Load(D(), block_.inverseLength + i);
        const V3 to = load3(block_.previous, i + kBlockLanes);
        const V3 moved = load3(block_.position, i + kBlockLanes) - to;
        const V3 edge = to - from_;
        now = edge * inverseLength;
        later = (edge + (moved - moved_) * q_) * inverseLength;
        from_ = to;
        moved_ = moved;
    }

  private:
    const BlockView& block_;
    const V q_;
    V3 from_, moved_;
    std::size_t lane_ = 0;
};

/// Share of the change that the tank pays, and what that leaves in it. Turning by the share α changes the
/// energy by ½ α² size − α gain.
HWY_INLINE V payFromTank(const BlockView& block, const SubstepContext& context, std::size_t lane, V gain,
                         V size) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V squared = all(context.h * context.h), slow = all(kLeakSpeed * kLeakSpeed);
    const V tank = hn::Load(D(), block.tank + lane);
    const auto fresh = tank < zero;
    const V saved = hn::Max(tank, zero) * squared;
    const V most = (gain + hn::Sqrt(gain * gain + (size + size) * saved)) / hn::Max(size, all(1e-30f));
    const V mostLeak = all(std::fmin(context.h / kLeakTime, 1.0f));
    const V leak = mostLeak * hn::Max(one - hn::Load(D(), block.motion + lane) / slow, zero);
    V part = hn::Max(hn::Min(most, one), leak);
    part = hn::IfThenElse(fresh, one, part);
    const V gained = part * (gain - all(0.5f) * part * size) / squared;
    const V kept = hn::Max(hn::Max(tank, zero) + gained, zero) * all(context.velocityShare);
    hn::Store(hn::IfThenElse(fresh, zero, kept), D(), block.tank + lane);
    return part;
}

/// Turns the curves that the joints hold with the root, and finds how far they go on towards those of the
/// frames at `previous`. The pulls leave out what turning a curve does to the frame's own strand, so curves
/// that simply followed would feed energy into curly hair without end. They follow as far as the strand's
/// tank lasts: it holds what earlier turning took out of the springs, so that no energy comes from nowhere
/// (passivity by energy tanks, as Duindam and Stramigioli 2004). While the strand rests, curves that lag
/// creep home.
HWY_INLINE void followFrames(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context,
                             std::size_t lane, Turning& turning) {
    const V zero = hn::Zero(D());
    const std::uint32_t first = block.firstFree - 1;
    const M3 turn = matrixOf(load4(lanes.turn, lane));
    V3 behind, normal;
    startFrames<true>(block, lanes, lane, behind, normal);
    V3 behindLater = behind;
    V gain = zero, size = zero;
    auto known = hn::Not(noLane());
    Directions directions(block, context, lane);
    for (std::uint32_t j = 0; j + 1 < block.points; ++j) {
        const std::size_t i = std::size_t{j} * kBlockLanes + lane;
        directions.read(j);
        const V3 tangent = directions.now;
        if (j >= first) {
            const V3 held = turn * load3(block.curve, i);
            const V3 goal = fromFrame(behind, normal, load3(block.target, i));
            const V3 change = onlyWhere(known, goal - held);
            const V stiffness = hn::Load(D(), block.stiffness + i);
            gain = gain + dot(tangent - behind - held, change) * stiffness;
            size = size + dot(change, change) * stiffness;
            store3(held, block.curve, i);
            turning.change.set(j, change);
            turning.ahead.set(j, directions.later - behindLater);
        }
        const V along = dot(behind, tangent);
        normal = carryNormal(normal, behind, tangent, along);
        known = hn::AndNot(along < all(kFold), known);
        behind = tangent;
        behindLater = directions.later;
    }
    turning.share = payFromTank(block, context, lane, gain, size);
}

/// What the segments pull with, read root to tip: the gradient of the bending energy by a segment's outer
/// point, (s_s − s_{s+1})/l times h², q of the way to `position` farther on than `previous`.
template <Shape kShape>
class SegmentPulls {
  public:
    HWY_INLINE SegmentPulls(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context,
                            std::size_t lane)
        : block_(block), lane_(lane), directions_(block, context, lane) {
        const std::uint32_t first = block.firstFree - 1;
        if constexpr (kShape == Shape::curved) {
            followFrames(block, lanes, context, lane, turning_);
        } else {
            V3 normal;
            startFrames<false>(block, lanes, lane, behind_, normal);
            for (std::uint32_t s = 0; s < first; ++s) {
                directions_.read(s);
                behind_ = directions_.later;
            }
        }
        pull_ = jointPull(first);
    }

    /// Of segment s, each from firstFree − 1 on after the one before.
    HWY_INLINE V3 next(std::uint32_t s) {
        const V3 inner = pull_;
        pull_ = s + 2 < block_.points ? jointPull(s + 1) : zero3();
        return (inner - pull_) * hn::Load(D(), block_.inverseLength + std::size_t{s} * kBlockLanes + lane_);
    }

  private:
    HWY_INLINE V3 jointPull(std::uint32_t j) {
        const std::size_t i = std::size_t{j} * kBlockLanes + lane_;
        V3 off;
        if constexpr (kShape == Shape::curved) {
            const V3 curve = load3(block_.curve, i) + turning_.change[j] * turning_.share;
            store3(curve, block_.curve, i);
            off = turning_.ahead[j] - curve;
        } else {
            directions_.read(j);
            off = directions_.later - behind_;
            behind_ = directions_.later;
        }
        return off * hn::Load(D(), block_.stiffness + i);
    }

    const BlockView& block_;
    const std::size_t lane_;
    Turning turning_;        // of curved hair
    Directions directions_;  // of straight hair
    V3 behind_;
    V3 pull_;
};

/// Solves (M + share·K) δ = −G along a strip of strands with the factors of the block, and calls take(index,
/// δ), tip to root. forceOf(s) is the force G of segment s on its outer point, reversed on its inner one; it
/// is asked for root to tip.
template <class ForceOf, class Take>
HWY_INLINE void solveBend(const BlockView& block, std::size_t lane, ForceOf&& forceOf, Take&& take) {
    StripRow3 rights;
    V3 last = zero3(), beforeLast = zero3();
    V3 inner = forceOf(block.firstFree - 1);
    for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        const V3 outer = p + 1 < block.points ? forceOf(p) : zero3();
        const V3 right = outer - inner - last * hn::Load(D(), block.lower1 + i) -
                         beforeLast * hn::Load(D(), block.lower2 + i);
        rights.set(p, right);
        beforeLast = last;
        last = right;
        inner = outer;
    }
    last = beforeLast = zero3();
    for (std::uint32_t p = block.points; p-- > block.firstFree;) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        V3 delta = rights[p] * hn::Load(D(), block.inverseDiagonal + i);
        if (p + 1 < block.points) delta = delta - last * hn::Load(D(), block.lower1 + i + kBlockLanes);
        if (p + 2 < block.points)
            delta = delta - beforeLast * hn::Load(D(), block.lower2 + i + 2 * kBlockLanes);
        take(i, delta);
        beforeLast = last;
        last = delta;
    }
}

/// Angular springs after position Verlet: the step of their force through (M + (¼ + q) h² K)⁻¹, stable for
/// any stiffness (docs/engine.md). With `kTense`, the tension of the last substep along the segments at the
/// start of this one joins the force.
template <Shape kShape, bool kTense>
HWY_INLINE void bendStrip(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context,
                          std::size_t lane) {
    SegmentPulls<kShape> pulls(block, lanes, context, lane);
    V3 from = load3(block.previous, std::size_t{block.firstFree - 1} * kBlockLanes + lane);
    const auto forceOf = [&](std::uint32_t s) HWY_ATTR {
        const V3 pull = pulls.next(s);
        if constexpr (!kTense) return pull;
        const std::size_t i = std::size_t{s} * kBlockLanes + lane;
        const V3 to = load3(block.previous, i + kBlockLanes);
        const V3 edge = to - from;
        from = to;
        return pull + edge * (hn::Load(D(), block.inverseLength + i) * hn::Load(D(), block.tension + i));
    };
    solveBend(block, lane, forceOf, [&](std::size_t i, V3 delta) HWY_ATTR {
        store3(load3(block.position, i) + delta, block.position, i);
    });
}

template <Shape kShape>
void bendBack(const BlockView& given, LaneFrame& lanes, const SubstepContext& context) {
    const BlockView block = localCopy(given);
    if (block.points <= block.firstFree) return;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        if (block.tension) {
            bendStrip<kShape, true>(block, lanes, context, lane);
        } else {
            bendStrip<kShape, false>(block, lanes, context, lane);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
