// SPDX-License-Identifier: MIT
// Collision with spheres.
#if defined(HAIRLOOM_RUNTIME_COLLIDE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_COLLIDE_INL_H
#undef HAIRLOOM_RUNTIME_COLLIDE_INL_H
#else
#define HAIRLOOM_RUNTIME_COLLIDE_INL_H
#endif

#include <cmath>

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Impulse with restitution (Rünz 2012, Eq. 20) and Coulomb friction, then the place p_a on the sphere (Eq.
/// 21, to which the centre is added). A point at the very centre leaves it upwards.
HWY_INLINE void respond(const BlockView& block, const SubstepContext& context, std::size_t i,
                        hn::Mask<D> inside, V3 offset, V squared, V3 centre, V reach, V3 centreStep) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V distance = hn::Sqrt(squared);
    const auto centred = distance < all(1e-9f);
    const V inverse = one / hn::IfThenElse(centred, one, distance);
    const V3 normal{hn::IfThenElse(centred, zero, offset.x * inverse),
                    hn::IfThenElse(centred, one, offset.y * inverse),
                    hn::IfThenElse(centred, zero, offset.z * inverse)};
    const V3 position = load3(block.position, i);
    const V3 previous = load3(block.previous, i);
    const V3 relative = position - previous - centreStep;
    const V approach = hn::Min(dot(relative, normal), zero);
    const V3 sliding = relative - normal * dot(relative, normal);
    const V impulse = (zero - approach) * all(1.0f + context.restitution);
    const V slidingSpeed = hn::Sqrt(dot(sliding, sliding));
    const V lost = hn::Min(all(context.friction) * impulse / (slidingSpeed + all(1e-20f)), one);
    const V3 after = relative + normal * impulse - sliding * lost;
    const V3 placed = centre + normal * reach;
    const V3 before = placed - (after + centreStep);
    store3(select(inside, placed, position), block.position, i);
    store3(select(inside, before, previous), block.previous, i);
}

/// Pushes points out of spheres (Rünz 2012, Eq. 14), pearls growing linearly to the tip. Spheres that do not
/// meet the block's bounding box are skipped.
void collide(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const float step = static_cast<float>(context.index + 1);
    const Box box = boundsOf(block, lanes, step);
    const float largestPearl = std::fmax(context.pearlRoot, context.pearlTip);
    const float pearlSlope = (context.pearlTip - context.pearlRoot) / static_cast<float>(block.points - 1);
    for (const MovingSphere& sphere : context.spheres) {
        const Float3 centre_ws = sphere.from_ws + sphere.step * step;
        if (!box.meets(centre_ws, sphere.radius + largestPearl)) continue;
        const V3 centreStep = all3(sphere.step);
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const V3 root = load3(lanes.root, lane) + load3(lanes.rootStep, lane) * all(step);
            const V3 centre = all3(centre_ws) - root;
            for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                const V reach = all(sphere.radius + context.pearlRoot + pearlSlope * static_cast<float>(p));
                const V3 offset = load3(block.position, i) - centre;
                const V squared = dot(offset, offset);
                const auto inside = squared < reach * reach;
                if (HWY_LIKELY(hn::AllFalse(D(), inside))) continue;
                respond(block, context, i, inside, offset, squared, centre, reach, centreStep);
            }
        }
    }
}

void applyPenalty(const BlockView&, LaneFrame&, const SubstepContext&) {}
void collideBack(const BlockView& b, LaneFrame& l, const SubstepContext& c) {
    collide(b, l, c);
}
void collideSwept(const BlockView&, LaneFrame&, const SubstepContext&) {}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
