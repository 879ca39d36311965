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
#include <type_traits>

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/bend-inl.h"
#include "models/springs/rows-inl.h"
#include "models/springs/spring_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Cosine of the turn, 162°, beyond which a normal is carried with care.
inline constexpr float kFold = -0.95f;

/// What a strip of strands works with in a substep, point after point, in LaneFrame::solver. A joint and the
/// segment behind a point have the point's number.
struct Strip {
    struct alignas(64) Point {
        Lanes3 direction;  ///< of the segment at the start of the substep, by its rest length
        Lanes3 ahead;      ///< what the joint pulls against q of the way on, reversed
        Lanes upper;       ///< of the system of lengths, as it is eliminated
        Lanes tension;     ///< likewise

        /// Right side of the system of bending; takes the place of `ahead`.
        Lanes3& right() { return ahead; }
    };
    Point* points;

    HWY_INLINE explicit Strip(const LaneFrame& lanes) : points(reinterpret_cast<Point*>(lanes.solver)) {}
};

/// Fills the directions of segments at `previous`, and by how much less each turns than the one before it, q
/// of the way to `position`.
template <class Rows>
HWY_INLINE void readSegments(const SpringBlock& block, const Rows& rows, const LaneFrame& lanes,
                             const SubstepContext& context, std::size_t lane, Strip& strip) {
    const float* previous = block.previous.x + lane;
    const float* position = block.position.x + lane;
    const std::size_t pitch = block.pitch;
    const V q = all(context.bendRate);
    V3 from = load3(previous, pitch), moved = load3(position, pitch) - from;
    V3 tangent = rootDirection(block, lanes, lane);
    auto row = rows.at(0);
    Strip::Point* at = strip.points;
    for (std::size_t left = block.points - 1; left > 0; --left, ++at, row.advance()) {
        previous += kBlockLanes;
        position += kBlockLanes;
        const V inverseLength = row.inverseLength();
        const V3 to = load3(previous, pitch);
        const V3 movedNext = load3(position, pitch) - to;
        const V3 edge = to - from;
        store3(edge * inverseLength, at->direction);
        const V3 nextTangent = mulAdd(movedNext - moved, q, edge) * inverseLength;
        store3(tangent - nextTangent, at->ahead);
        tangent = nextTangent;
        from = to;
        moved = movedNext;
    }
}

/// Takes the joints' curves, in the frames at `previous`, off what they pull against; returns the least
/// cosine of a turn. Without `kFolds` it is right only where that is above kFold.
template <bool kFolds, class Rows>
HWY_INLINE V takeCurves(const SpringBlock& block, const Rows& rows, const LaneFrame& lanes, std::size_t lane,
                        Strip& strip) {
    V3 behind = rootDirection(block, lanes, lane), normal = rootNormal(block, lanes, lane);
    V sharpest = all(1.0f);
    const auto carry = [&](V3 tangent) HWY_ATTR {
        const V along = dot(behind, tangent);
        normal = kFolds ? carryNormal(normal, behind, tangent, along)
                        : carryOpenNormal(normal, behind, tangent, along);
        sharpest = hn::Min(sharpest, along);
        behind = tangent;
    };
    Strip::Point* at = strip.points;
    for (const Strip::Point* const first = at + (block.firstFree - 1); at < first; ++at)
        carry(load3(at->direction));
    auto row = rows.at(block.firstFree - 1);
    for (const Strip::Point* const end = strip.points + (block.points - 1); at < end; ++at, row.advance()) {
        store3(load3(at->ahead) + fromFrame(behind, normal, row.target()), at->ahead);
        carry(load3(at->direction));
    }
    return sharpest;
}

/// What the segments pull with, read root to tip: the gradient of the bending energy by a segment's outer
/// point, (s_s − s_{s+1})/l times h², q of the way to `position` farther on than `previous`. Nothing bends at
/// the tip. Fills the segments' directions.
template <Shape kShape>
class SegmentPulls {
  public:
    template <class Rows>
    HWY_INLINE SegmentPulls(const SpringBlock& block, const Rows& rows, const LaneFrame& lanes,
                            const SubstepContext& context, std::size_t lane, Strip& strip) {
        readSegments(block, rows, lanes, context, lane, strip);
        if constexpr (kShape == Shape::curved) {
            const V sharpest = takeCurves<false>(block, rows, lanes, lane, strip);
            if (HWY_UNLIKELY(!hn::AllFalse(D(), sharpest < all(kFold)))) {
                readSegments(block, rows, lanes, context, lane, strip);
                takeCurves<true>(block, rows, lanes, lane, strip);
            }
        }
        const std::size_t first = block.firstFree - 1;
        push_ = jointPush(rows.at(first), strip.points[first]);
    }

    /// Of a segment, from firstFree − 1 on each after the one before, but the last.
    template <class Row>
    HWY_INLINE V3 next(const Row& row, const Strip::Point& point) {
        const V3 inner = push_;
        push_ = jointPush(row + 1, *(&point + 1));
        return (push_ - inner) * row.inverseLength();
    }
    template <class Row>
    HWY_INLINE V3 last(const Row& row) const {
        return (zero3() - push_) * row.inverseLength();
    }

  private:
    /// A joint's pull, reversed.
    template <class Row>
    HWY_INLINE V3 jointPush(const Row& row, const Strip::Point& point) const {
        return load3(point.ahead) * row.stiffness();
    }

    V3 push_;
};

/// Eliminates the points of a strip, root to tip, from (M + share·K) δ = −G with the factors of the block.
/// forceOf(row, point, isLast) is the force G of a segment on its outer point, reversed on its inner one; it
/// is asked for root to tip, with std::true_type for the last one.
template <class Rows, class ForceOf>
HWY_INLINE void reduceBend(const SpringBlock& block, const Rows& rows, Strip& strip, ForceOf&& forceOf) {
    constexpr std::false_type kGoesOn;
    constexpr std::true_type kLast;
    V3 last = zero3(), beforeLast = zero3(), inner = zero3();
    auto row = rows.at(block.firstFree - 1);
    Strip::Point* at = strip.points + (block.firstFree - 1);
    const auto eliminate = [&](V3 outer) HWY_ATTR {
        // The last row takes part last: that is all that a row waits for.
        const V3 far = negMulAdd(beforeLast, row.lower2(), outer - inner);
        const V3 right = negMulAdd(last, row.lower1(), far);
        store3(right, at->right());
        beforeLast = last;
        last = right;
        inner = outer;
    };
    // The system begins with the outer point of the first segment.
    const std::size_t segments = block.points - block.firstFree;
    if (segments == 1) {
        inner = forceOf(row, *at, kLast);
    } else {
        inner = forceOf(row, *at, kGoesOn);
        for (std::size_t left = segments - 1; left > 1; --left) {
            row.advance();
            ++at;
            eliminate(forceOf(row, *at, kGoesOn));
        }
        row.advance();
        ++at;
        eliminate(forceOf(row, *at, kLast));
    }
    row.advance();
    ++at;
    eliminate(zero3());
}

/// Calls tip(row, point, δ) for the last point and take(row, point, δ) for each one before it, tip to root.
template <class Rows, class Tip, class Take>
HWY_INLINE void finishBend(const SpringBlock& block, const Rows& rows, Strip& strip, Tip&& tip, Take&& take) {
    auto row = rows.at(block.points - 1);
    Strip::Point* at = strip.points + (block.points - 1);
    V3 delta = load3(at->right()) * row.inverseDiagonal();
    // What the points solved so far take off the next one and the one after it.
    V3 next = delta * row.lower1(), afterNext = delta * row.lower2();
    tip(row, *at, delta);
    for (std::size_t left = block.points - block.firstFree; left > 1; --left) {
        row.retreat();
        --at;
        delta = mulSub(load3(at->right()), row.inverseDiagonal(), next);
        next = mulAdd(delta, row.lower1(), afterNext);
        afterNext = delta * row.lower2();
        take(row, *at, delta);
    }
}

/// Angular springs after position Verlet: the step of their force through (M + (¼ + q) h² K)⁻¹, stable for
/// any stiffness (docs/engine.md). With `kTense`, the tension of the last substep along the segments at the
/// start of this one joins the force.
template <Shape kShape, bool kTense, class Rows>
HWY_INLINE void pullStrip(const SpringBlock& block, const Rows& rows, const LaneFrame& lanes,
                          const SubstepContext& context, std::size_t lane, Strip& strip) {
    SegmentPulls<kShape> pulls(block, rows, lanes, context, lane, strip);
    reduceBend(block, rows, strip, [&](const auto& row, const Strip::Point& point, auto isLast) HWY_ATTR {
        V3 pull;
        if constexpr (isLast) {
            pull = pulls.last(row);
        } else {
            pull = pulls.next(row, point);
        }
        if constexpr (!kTense) return pull;
        return mulAdd(load3(point.direction), row.tension(), pull);
    });
}

template <Shape kShape>
void bendBack(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    if (block.points <= block.firstFree) return;
    Strip strip(lanes);
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const PlaneRows rows(block, lane);
        if (block.tension) {
            pullStrip<kShape, true>(block, rows, lanes, context, lane, strip);
        } else {
            pullStrip<kShape, false>(block, rows, lanes, context, lane, strip);
        }
        float* at = block.position.x + (block.points - 1) * kBlockLanes + lane;
        const auto move = [&](const auto&, const Strip::Point&, V3 delta) HWY_ATTR {
            store3(load3(at, block.pitch) + delta, at, block.pitch);
            at -= kBlockLanes;
        };
        finishBend(block, rows, strip, move, move);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
