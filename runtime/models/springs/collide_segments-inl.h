// SPDX-License-Identifier: MIT
// Collision of segments with spheres.
#if defined(HAIRLOOM_RUNTIME_COLLIDE_SEGMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_COLLIDE_SEGMENTS_INL_H
#undef HAIRLOOM_RUNTIME_COLLIDE_SEGMENTS_INL_H
#else
#define HAIRLOOM_RUNTIME_COLLIDE_SEGMENTS_INL_H
#endif

#include <algorithm>
#include <cstdint>

#include "engine/lanes-inl.h"
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Pushes segments out of spheres as cylinders (Choe, Choi, Ko 2005): the point of a segment's axis that is
/// nearest to the centre keeps the collision radius there. Its two points share the push as their levers and
/// masses of 1 have it, and the impulse with restitution (Eq. 20) and friction likewise. A clamped point
/// does not move: where it is inside itself nothing turns the segment out, and where the sphere is nearer to
/// it than a tenth of the segment the lever of the other would be too short.
HWY_NOINLINE void collideSegments(const SpringBlock& block, const LaneFrame& lanes,
                                  const SubstepContext& context) {
    alignas(64) float collisionRadii[kMaxPoints];
    fillCollisionRadii(block, context, collisionRadii);
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V step = all(static_cast<float>(context.index + 1));
    for (std::uint32_t p = std::max(block.firstFree, 1u); p < block.points; ++p) {
        const bool innerMoves = p - 1 >= block.firstFree;
        const V innerMass = all(innerMoves ? 1.0f : 0.0f);
        for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
            const std::size_t outer = std::size_t{p} * kBlockLanes + lane, inner = outer - kBlockLanes;
            const V3 root = load3(lanes.root, lane) + load3(lanes.rootDisplacement, lane) * step;
            for (const MovingSphere& sphere : context.spheres) {
                const V3 centre =
                    all3(sphere.from_ws + sphere.step * static_cast<float>(context.index + 1)) - root;
                const V3 a = load3(block.position, inner), b = load3(block.position, outer), edge = b - a;
                const V along = dot(centre - a, edge) / hn::Max(dot(edge, edge), all(1e-20f));
                const V t = hn::Min(hn::Max(along, zero), one), left = one - t;
                const V3 from = a + edge * t - centre;
                const V reach = all(sphere.radius + collisionRadii[p - 1]) +
                                all(collisionRadii[p] - collisionRadii[p - 1]) * t;
                // Points themselves have met the sphere already.
                auto between = hn::And(along > zero, along < one);
                if (!innerMoves) {
                    const V3 clamped = a - centre;
                    const V itsReach = all(sphere.radius + collisionRadii[p - 1]);
                    between = hn::And(between, dot(clamped, clamped) >= itsReach * itsReach);
                    between = hn::And(between, t >= all(0.1f));
                }
                const auto touching = hn::And(between, dot(from, from) < reach * reach);
                if (HWY_LIKELY(hn::AllFalse(D(), touching))) continue;
                const Direction direction = directionOf(from);
                const V3 normal = direction.from * direction.inverse;
                const V3 beforeA = load3(block.previous, inner), beforeB = load3(block.previous, outer);
                const V3 wayA = a - beforeA, wayB = b - beforeB;
                const V3 relative = wayA + (wayB - wayA) * t - all3(sphere.step);
                const V speed = dot(relative, normal), approach = hn::Max(zero - speed, zero);
                const V3 sliding = relative - normal * speed;
                const V impulse = approach * all(1.0f + context.restitution);
                const V slid = hn::Sqrt(hn::Max(dot(sliding, sliding), all(1e-30f)));
                const V lost = hn::Min(all(context.friction) * impulse / slid, one);
                const V3 push = normal * (reach - direction.length);
                const V3 change = normal * impulse - sliding * lost;
                const V lever = one / hn::Max(left * left * innerMass + t * t, all(1e-6f));
                const auto move = [&](std::size_t i, V3 at, V3 before, V share) HWY_ATTR {
                    const V3 placed = at + push * share;
                    store3(select(touching, placed, at), block.position, i);
                    store3(select(touching, placed - ((at - before) + change * share), before),
                           block.previous, i);
                };
                move(outer, b, beforeB, lever * t);
                if (innerMoves) move(inner, a, beforeA, lever * left);
            }
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
