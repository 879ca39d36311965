// SPDX-License-Identifier: MIT
// Collisions between the positions of two substeps, with spheres that fast points would pass.
#if defined(HAIRLOOM_RUNTIME_CONTINUOUS_COLLISION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_CONTINUOUS_COLLISION_INL_H
#undef HAIRLOOM_RUNTIME_CONTINUOUS_COLLISION_INL_H
#else
#define HAIRLOOM_RUNTIME_CONTINUOUS_COLLISION_INL_H
#endif

#include "engine/lanes-inl.h"
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
#include "models/springs/collide-inl.h"
#include "models/springs/near-inl.h"
#include "models/springs/spring_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// The first sphere that a point enters and passes the middle of on its way relative to it, as a contact.
HWY_INLINE Contact firstEntered(const SubstepContext& context, V3 at, V3 moved, V3 root, V collisionRadius,
                                float step) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    Contact first{noLane(), zero3(), zero3(), zero, zero3()};
    V earliest = zero;
    for (const MovingSphere& sphere : context.spheres) {
        const V3 centre = all3(sphere.from_ws + sphere.step * step) - root;
        const V reach = all(sphere.radius) + collisionRadius;
        const V3 relative = moved - all3(sphere.step);
        const V3 offset = at - centre;
        const V a = dot(relative, relative), b = dot(relative, offset);
        const V discriminant = b * b - a * (dot(offset, offset) - reach * reach);
        const V fast = all(kUnsweptShare) * reach;
        const auto passes = hn::And(a > fast * fast, hn::And(b > zero, discriminant > zero));
        if (HWY_LIKELY(hn::AllFalse(D(), passes))) continue;
        const V s = zero - (b + hn::Sqrt(hn::Max(discriminant, zero))) / hn::IfThenElse(passes, a, one);
        const auto sooner = hn::And(passes, hn::And(s >= all(-1.0f), s < earliest));
        earliest = hn::IfThenElse(sooner, s, earliest);
        first.touching = hn::Or(first.touching, sooner);
        first.centre = select(sooner, centre, first.centre);
        first.step = select(sooner, all3(sphere.step), first.step);
        first.reach = hn::IfThenElse(sooner, reach, first.reach);
        first.from = select(sooner, offset + relative * s, first.from);
    }
    return first;
}

/// Catches points that move at least as far as slowestSwept where they first enter a sphere that they have
/// passed, or passed the middle of, by the end of the substep.
HWY_NOINLINE void catchFast(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    const float slow = context.slowestSwept;
    const float step = static_cast<float>(context.index + 1);
    alignas(64) float collisionRadii[kMaxPoints];
    fillCollisionRadii(block, context, collisionRadii);
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const V3 root = load3(lanes.root, lane) + load3(lanes.rootDisplacement, lane) * all(step);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 at = load3(block.position, i);
            const V3 moved = at - load3(block.previous, i);
            if (hn::AllFalse(D(), dot(moved, moved) >= all(slow * slow))) continue;
            const Contact first = firstEntered(context, at, moved, root, all(collisionRadii[p]), step);
            if (!hn::AllFalse(D(), first.touching)) respond(block, context, i, first);
        }
    }
}

/// Squares of the farthest that free points are from where they were, square metres.
struct Farthest {
    float inSubstep;  ///< at the end of the last one
    float fromList;   ///< when the list of near points was made
};

HWY_INLINE float farthestInSubstep(const SpringBlock& block) {
    return maxOfBlock(block, [&](std::size_t i) HWY_ATTR {
        const V3 moved = load3(block.position, i) - load3(block.previous, i);
        return dot(moved, moved);
    });
}

/// Both in one pass.
HWY_INLINE Farthest farthestOfBoth(const SpringBlock& block, const NearPoints& near) {
    const ConstPlanes positions{near.positions, nearPlane(block)};
    V ofSubstep = hn::Zero(D()), ofList = hn::Zero(D());
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        V inSubstep = hn::Zero(D()), fromList = hn::Zero(D());
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 at = load3(block.position, i);
            const V3 moved = at - load3(block.previous, i), left = at - load3(positions, i);
            inSubstep = hn::Max(inSubstep, dot(moved, moved));
            fromList = hn::Max(fromList, dot(left, left));
        }
        ofSubstep = hn::Max(ofSubstep, inSubstep);
        ofList = hn::Max(ofList, fromList);
    }
    return {laneMax(ofSubstep), laneMax(ofList)};
}

HWY_INLINE bool isFast(const SubstepContext& context, float farthestSquared) {
    return !(farthestSquared < context.slowestSwept * context.slowestSwept);
}

/// Runs before the stage of collisions and leaves slow blocks at once.
void continuousCollision(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    if (isFast(context, farthestInSubstep(block))) catchFast(block, lanes, context);
}

template <bool kBackward>
void bothCollisions(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    Farthest farthest{0.0f, 0.0f};
    if (springLanes(lanes).near.made) {
        farthest = farthestOfBoth(block, springLanes(lanes).near);
    } else {
        farthest.inSubstep = farthestInSubstep(block);
    }
    if (HWY_UNLIKELY(isFast(context, farthest.inSubstep))) {
        catchFast(block, lanes, context);
        if (springLanes(lanes).near.made)
            farthest.fromList = farthestFromList(block, springLanes(lanes).near);
    }
    collideWith<kBackward>(block, lanes, context, farthest.fromList);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
