// SPDX-License-Identifier: MIT
// Which points of a block are near which spheres, found once for several substeps.
#if defined(HAIRLOOM_RUNTIME_NEAR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_NEAR_INL_H
#undef HAIRLOOM_RUNTIME_NEAR_INL_H
#else
#define HAIRLOOM_RUNTIME_NEAR_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "engine/lanes-inl.h"
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// What a list of near points is made from; `roots` are those of this substep.
struct NearInput {
    const SpringBlock& block;
    const LaneFrame& lanes;
    const SubstepContext& context;
    const SphereSet& spheres;
    const float* collisionRadii;
    const float (*roots)[kBlockLanes];
};

/// Points of a strand whose box is tested against spheres.
inline constexpr std::uint32_t kPartPoints = 8;

/// Calls visit(lane, begin, end) for the parts of each strip, kPartPoints free points each, until it is
/// false.
template <class Visit>
HWY_INLINE bool forEachPart(const SpringBlock& block, Visit&& visit) {
    for (std::uint32_t p = block.firstFree; p < block.points; p += kPartPoints) {
        const std::uint32_t end = std::min(p + kPartPoints, block.points);
        for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
            if (!visit(lane, p, end)) return false;
        }
    }
    return true;
}

/// Writes points begin … end − 1 of a strip, each with the spheres that come within `margin` of it,
/// from `list` on, where there is room for all there can be and one more. Returns their end.
HWY_INLINE NearPoints::Pair* findPairs(const NearInput& in, std::uint32_t lane, std::uint32_t begin,
                                       std::uint32_t end, float margin, NearPoints::Pair* list) {
    const V3 root = load3(in.roots, lane);
    WideBox world = WideBox::empty();
    world.add(boxOf(in.block, lane, begin, end), root);
    in.spheres.forEachMeeting(world.reduced(), margin, [&](std::size_t k) HWY_ATTR {
        const V3 centre = in.spheres.centre(k) - root;
        std::size_t i = std::size_t{begin} * kBlockLanes + lane;
        for (std::uint32_t p = begin; p < end; ++p, i += kBlockLanes) {
            const float reach = in.spheres.radius[k] + in.collisionRadii[p], wider = reach + margin;
            const V3 offset = load3(in.block.position, i) - centre;
            const auto inside = dot(offset, offset) < all(wider * wider * 1.0001f);
            // Written first: a branch on what is as good as random costs more.
            *list = {NearPoints::Pair::join(k, i), reach * reach};
            list += hn::AllFalse(D(), inside) ? 0 : 1;
        }
    });
    return list;
}

/// Metres in a substep that a sphere moves relative to a root of the block, at most.
HWY_INLINE float fastestSphere(const NearInput& in) {
    V maximum = hn::Zero(D());
    for (std::uint32_t lane = 0; lane < in.block.lanes; lane += kWidth) {
        const V3 step = load3(in.lanes.rootDisplacement, lane);
        for (const MovingSphere& sphere : in.context.spheres) {
            const V3 relative = all3(sphere.step) - step;
            maximum = hn::Max(maximum, dot(relative, relative));
        }
    }
    return std::sqrt(laneMax(maximum));
}

/// Metres by which rounding can move a sphere relative to a root.
HWY_INLINE float roundingOfPositions(const NearInput& in) {
    V maximum = hn::Zero(D());
    for (std::uint32_t lane = 0; lane < in.block.lanes; lane += kWidth) {
        const V3 root = load3(in.roots, lane);
        maximum = hn::Max(maximum, hn::Max(hn::Abs(root.x), hn::Max(hn::Abs(root.y), hn::Abs(root.z))));
    }
    float farthest = laneMax(maximum);
    for (const MovingSphere& sphere : in.context.spheres)
        farthest = std::fmax(farthest, length(sphere.from_ws) + length(sphere.step));
    return 2e-6f * farthest;
}

/// Metres that a point of the block moved relative to its root in this substep, at most.
HWY_INLINE float farthestFromRoot(const NearInput& in) {
    return std::sqrt(maxOfBlock(in.block, [&](std::size_t i) HWY_ATTR {
        const V3 step = load3(in.lanes.rootDisplacement, i % kBlockLanes);
        const V3 moved = load3(in.block.position, i) - load3(in.block.previous, i) - step;
        return dot(moved, moved);
    }));
}

HWY_INLINE std::size_t nearPlane(const SpringBlock& block) {
    return std::size_t{block.points} * kBlockLanes + kPlanePadding;
}

/// For the rest of the frame, should the points go on as they do, but not with so wide a margin that all are
/// near.
HWY_INLINE float marginFor(const NearInput& in, float sphereStep) {
    const auto left = static_cast<float>(in.context.count - in.context.index - 1);
    float smallest = 1e30f;
    for (const MovingSphere& sphere : in.context.spheres) smallest = std::fmin(smallest, sphere.radius);
    const float wanted = left * (1.25f * farthestFromRoot(in) + sphereStep) + 5e-4f;
    return std::fmin(wanted, 0.5f * smallest);
}

/// Makes the list, where there is room for it.
HWY_INLINE void findNear(const NearInput& in, NearPoints& near) {
    near.substep = in.context.index;
    near.step = fastestSphere(in);
    near.margin = marginFor(in, near.step);
    const float wider = near.margin + roundingOfPositions(in);
    NearPoints::Pair* last = near.pairs;
    near.made =
        forEachPart(in.block, [&](std::uint32_t lane, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
            const std::size_t room = NearPoints::kMaxPairs - static_cast<std::size_t>(last - near.pairs);
            if (room < in.spheres.count() * (end - begin)) return false;
            last = findPairs(in, lane, begin, end, wider, last);
            return true;
        });
    if (!near.made) return;
    near.pairCount = static_cast<std::uint32_t>(last - near.pairs);
    const Planes positions{near.positions, nearPlane(in.block)};
    const std::size_t end = std::size_t{in.block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{in.block.firstFree} * kBlockLanes; i < end; i += kWidth)
        store3(load3(in.block.position, i), positions, i);
}

/// Square of the farthest that a free point is from where it was when the list was made, square metres.
HWY_INLINE float farthestFromList(const SpringBlock& block, const NearPoints& near) {
    const ConstPlanes positions{near.positions, nearPlane(block)};
    return maxOfBlock(block, [&](std::size_t i) HWY_ATTR {
        const V3 moved = load3(block.position, i) - load3(positions, i);
        return dot(moved, moved);
    });
}

/// Whether points that are no farther than this from where they were when the list was made, in square
/// metres, have not left the margin.
HWY_INLINE bool isStillNear(const SubstepContext& context, const NearPoints& near, float fromList) {
    const float limit = 0.999f * near.margin - static_cast<float>(context.index - near.substep) * near.step;
    return limit > 0.0f && fromList < limit * limit;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
