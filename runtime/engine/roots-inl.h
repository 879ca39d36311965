// SPDX-License-Identifier: MIT
// Takes in and moves the roots, and measures how fast points are.
#if defined(HAIRLOOM_RUNTIME_ROOTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROOTS_INL_H
#undef HAIRLOOM_RUNTIME_ROOTS_INL_H
#else
#define HAIRLOOM_RUNTIME_ROOTS_INL_H
#endif

#include <cfloat>
#include <cmath>

#include "engine/checks.h"
#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Of the two quaternions of a rotation the one on the side of another: between these a root turns.
HWY_INLINE V4 onSideOf(V4 other, V4 q) {
    const V side = other.x * q.x + other.y * q.y + other.z * q.z + other.w * q.w;
    const V sign = hn::IfThenElse(side < hn::Zero(D()), all(-1.0f), all(1.0f));
    return {q.x * sign, q.y * sign, q.z * sign, q.w * sign};
}

/// Turns the roots to where they are at the end of the substep and takes the clamped points along.
void moveRoots(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V t = all(static_cast<float>(context.index + 1) / static_cast<float>(context.count));
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const V4 from = load4(lanes.rotationFrom, lane);
        if (context.index == 0) store4(onSideOf(from, load4(lanes.rotationTo, lane)), lanes.rotationTo, lane);
        const V4 to = load4(lanes.rotationTo, lane);
        const V4 mixed{lerp(from.x, to.x, t), lerp(from.y, to.y, t), lerp(from.z, to.z, t),
                       lerp(from.w, to.w, t)};
        const V norm =
            hn::Sqrt(mixed.x * mixed.x + mixed.y * mixed.y + mixed.z * mixed.z + mixed.w * mixed.w);
        const V inverse = all(1.0f) / norm;
        const V4 now{mixed.x * inverse, mixed.y * inverse, mixed.z * inverse, mixed.w * inverse};
        store4(now, lanes.rotation, lane);

        const V3 step = load3(lanes.rootDisplacement, lane);
        const V zero = hn::Zero(D());
        store3({zero - step.x, zero - step.y, zero - step.z}, block.previous, lane);
        if (block.firstFree > 1 && block.points > 1) {
            const std::size_t i = kBlockLanes + lane;
            store3(load3(block.position, i) - step, block.previous, i);
            store3(rotate(now, load3(block.rest, lane)), block.position, i);
        }
    }
}

/// As usableWithin(), for each lane.
HWY_INLINE hn::Mask<D> usableRoots(V3 position, V squaredRotation) {
    const auto near = dot(position, position) <= all(kFarthest * kFarthest);
    return hn::And(near, hn::And(squaredRotation > all(1e-12f), squaredRotation <= all(FLT_MAX)));
}

bool takeRoots(const float* before, float* next, bool sound, float teleportDistanceSquared,
               RootBounds& bounds) {
    const Planes positions{next, kBlockLanes};
    const auto rotationAt = [&](std::size_t lane) HWY_ATTR {
        const float* const at = next + 3 * kBlockLanes + lane;
        return V4{hn::Load(D(), at), hn::Load(D(), at + kBlockLanes), hn::Load(D(), at + 2 * kBlockLanes),
                  hn::Load(D(), at + 3 * kBlockLanes)};
    };
    const auto squareOf = [](V4 q) HWY_ATTR { return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w; };
    if (!sound) {
        auto usable = hn::Not(noLane());
        for (std::size_t lane = 0; lane < kBlockLanes; lane += kWidth)
            usable = hn::And(usable, usableRoots(load3(positions, lane), squareOf(rotationAt(lane))));
        if (!hn::AllTrue(D(), usable)) return false;
    }
    for (std::size_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        if (!sound) {
            const V4 q = rotationAt(lane);
            const V inverse = all(1.0f) / hn::Sqrt(squareOf(q));
            store3({q.x * inverse, q.y * inverse, q.z * inverse}, Planes{next + 3 * kBlockLanes, kBlockLanes},
                   lane);
            hn::Store(q.w * inverse, D(), next + 6 * kBlockLanes + lane);
        }
        const V3 position = load3(positions, lane),
                 displacement = position - load3(ConstPlanes{before, kBlockLanes}, lane);
        const V3 low = load3(bounds.low, lane), high = load3(bounds.high, lane);
        store3({hn::Min(low.x, position.x), hn::Min(low.y, position.y), hn::Min(low.z, position.z)},
               bounds.low, lane);
        store3({hn::Max(high.x, position.x), hn::Max(high.y, position.y), hn::Max(high.z, position.z)},
               bounds.high, lane);
        const V squared = dot(displacement, displacement);
        const auto inPlace = squared <= all(teleportDistanceSquared);
        bounds.anyTeleported = bounds.anyTeleported || !hn::AllTrue(D(), inPlace);
        const V counted = hn::IfThenElseZero(inPlace, squared);
        hn::Store(hn::Max(hn::Load(D(), bounds.longest + lane), counted), D(), bounds.longest + lane);
    }
    return true;
}

float fastestOf(const BlockView& block) {
    // Bits of numbers that are not negative have the order of the numbers; what is no number comes after.
    using Bits = hn::RebindToUnsigned<D>;
    const auto bitsOfSquare = [](V3 v) HWY_ATTR { return hn::BitCast(Bits(), dot(v, v)); };
    // Squares of positions farther than this from their root leave single precision.
    const V maximum = all(1e12f);
    V ofAll = hn::Zero(D());
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        auto fastest = hn::Zero(Bits()), farthest = hn::Zero(Bits());
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            fastest = hn::Max(fastest, bitsOfSquare(position - load3(block.previous, i)));
            farthest = hn::Max(farthest, bitsOfSquare(position));
        }
        const V squared = hn::BitCast(D(), fastest);
        const auto sound = hn::And(squared < maximum, hn::BitCast(D(), farthest) < maximum);
        ofAll = hn::Max(ofAll, hn::IfThenElse(sound, squared, all(HUGE_VALF)));
    }
    return laneMax(ofAll);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
