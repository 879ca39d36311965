// SPDX-License-Identifier: MIT
// Collision with spheres (Rünz 2012, Section 3.4).
#if defined(HAIRLOOM_RUNTIME_COLLIDE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_COLLIDE_INL_H
#undef HAIRLOOM_RUNTIME_COLLIDE_INL_H
#else
#define HAIRLOOM_RUNTIME_COLLIDE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "engine/lanes-inl.h"
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
#include "models/springs/collide_segments-inl.h"
#include "models/springs/near-inl.h"
#include "models/springs/spring_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// What a vector of points touches; each lane may touch another sphere.
struct Contact {
    hn::Mask<D> touching;
    V3 centre;  ///< relative to the roots
    V3 step;    ///< the sphere's displacement in one substep
    V reach;    ///< of the sphere and of the strand
    V3 from;    ///< from the centre into the direction in which the point is placed; any length
};

/// Places the points on their spheres (Eq. 21, to which the centre is added) and gives them the impulse with
/// restitution (Eq. 20) and Coulomb friction, both relative to the sphere. Returns the positions, of all
/// lanes.
HWY_INLINE V3 respond(const SpringBlock& block, const SubstepContext& context, std::size_t i,
                      const Contact& contact) {
    const V zero = hn::Zero(D());
    const V3 position = load3(block.position, i);
    const V3 previous = load3(block.previous, i);
    const V3 relative = position - previous - contact.step;
    // One contact is one long chain of operations: what need not wait for the root stands beside it.
    const Direction direction = directionOf(contact.from);
    const V along = dot(relative, direction.from) * direction.inverse;
    const V3 normal = direction.from * direction.inverse;
    const V3 sliding = negMulAdd(normal, along, relative);
    const V slidingSquared = hn::NegMulAdd(along, along, dot(relative, relative));
    const V approach = hn::Max(zero - along, zero);
    const V bounce = all(1.0f + context.restitution);
    const V impulse = approach * bounce;
    const V rate = all(context.friction) * bounce * inverseSqrt(hn::Max(slidingSquared, all(1e-30f)));
    const V lost = hn::Min(rate * approach, all(1.0f));
    // Friction also takes back what the point has slid while inside, or sticking hair would creep.
    const V depth = hn::Max(contact.reach - direction.length, zero);
    const V slid = hn::Min(rate * hn::Min(depth, approach), all(1.0f));
    const V3 after = negMulAdd(sliding, lost, mulAdd(normal, impulse, relative));
    const V3 placed = negMulAdd(sliding, slid, mulAdd(normal, contact.reach, contact.centre));
    const V3 before = placed - (after + contact.step);
    // Stores of some lanes take processors of AMD a dozen cycles each.
    store3(select(contact.touching, placed, position), block.position, i);
    store3(select(contact.touching, before, previous), block.previous, i);
    return placed;
}

/// From the centre to the position p_b where the way of this substep entered the sphere: the s < 0 that
/// solves |p + s·v − c| = reach, with v relative to the sphere. Where that way does not begin outside, the
/// position is p_a, or a point that hardly moves would leave along any chord; likewise where the way enters
/// flatter than 1 in 20, as the position would follow from rounding.
HWY_INLINE V3 backAlong(V3 offset, V3 relative, V squared, V reach) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V a = dot(relative, relative);
    const V b = dot(relative, offset);
    const V c = squared - reach * reach;
    const V discriminant = b * b - a * c;
    const V root = hn::Sqrt(hn::Max(discriminant, zero));
    // Of the two forms of the root the one whose sum does not cancel.
    const auto approaching = b < zero;
    const V above = hn::IfThenElse(approaching, c, zero - (b + root));
    const V below = hn::IfThenElse(approaching, root - b, a);
    const auto moving = a > all(1e-20f);
    const V s = above / hn::IfThenElse(moving, below, one);
    const auto steep = discriminant > a * reach * reach * all(0.0025f);
    const auto onPath = hn::And(hn::And(moving, steep), hn::And(s >= all(-1.0f), s <= zero));
    return select(onPath, offset + relative * s, offset);
}

/// The point of the circle in which the contact's sphere and another one meet that is nearest to `at`, from
/// the other's centre; `meet` is false where they do not meet in a circle.
HWY_INLINE V3 nearestOfCircle(V3 at, const Contact& contact, V3 centre, V reach, hn::Mask<D>& meet) {
    const V zero = hn::Zero(D()), tiny = all(1e-12f);
    const V3 axis = contact.centre - centre;
    const V squared = dot(axis, axis);
    const V share =
        all(0.5f) * (squared + reach * reach - contact.reach * contact.reach) / hn::Max(squared, tiny);
    const V circle = reach * reach - share * share * squared;
    const V3 offset = at - centre;
    const V3 across = offset - axis * (dot(offset, axis) / hn::Max(squared, tiny));
    const V acrossSquared = dot(across, across);
    meet = hn::And(squared > tiny, hn::And(circle > zero, acrossSquared > tiny));
    return axis * share +
           across * (hn::Sqrt(hn::Max(circle, zero)) * inverseSqrt(acrossSquared + all(1e-30f)));
}

/// Metres that rounding leaves of a point inside the sphere that it was placed on.
inline constexpr float kLeft = 4e-6f;

/// Spheres of a set that can overlap each other, in one frame.
class Overlaps {
  public:
    HWY_INLINE Overlaps(const SubstepContext& context, const SphereSet& spheres, NearPoints& near)
        : context_(context), spheres_(spheres), near_(near) {}

    /// Those that can overlap sphere k, as bits.
    HWY_INLINE std::uint64_t of(std::size_t k) {
        const std::uint64_t bit = std::uint64_t{1} << k;
        if ((near_.overlapsKnown & bit) == 0) near_.overlaps[k] = spheres_.overlapping(k, margin());
        near_.overlapsKnown |= bit;
        return near_.overlaps[k];
    }
    /// Those that can overlap one of `some`.
    HWY_INLINE std::uint64_t ofAny(std::uint64_t some) {
        std::uint64_t all = some;
        for (; some != 0; some &= some - 1) all |= of(static_cast<std::size_t>(std::countr_zero(some)));
        return all;
    }

  private:
    /// Metres that two spheres can come nearer in the frame.
    HWY_NOINLINE float margin() const {
        float fastest = 0.0f;
        for (const MovingSphere& sphere : context_.spheres) fastest = std::fmax(fastest, length(sphere.step));
        return 2.0f * fastest * static_cast<float>(context_.count);
    }

    const SubstepContext& context_;
    const SphereSet& spheres_;
    NearPoints& near_;
};

/// About twice the reach times the depth of a point in a sphere, from its offset from the centre.
HWY_INLINE V depthIn(V3 offset, V reach) {
    return reach * (reach - all(kLeft)) - dot(offset, offset);
}

/// A few points of each strand of a block against the spheres of one set. Works in passes over lists, which
/// are filled without branches: whether a point touches is as good as random to a processor.
template <bool kBackward>
class Contacts {
  public:
    HWY_INLINE Contacts(const SpringBlock& block, const LaneFrame& lanes, const SubstepContext& context,
                        const SphereSet& spheres, const float* collisionRadii, NearPoints& near)
        : block_(block),
          context_(context),
          spheres_(spheres),
          collisionRadii_(collisionRadii),
          overlaps_(context, spheres, near),
          near_(near),
          in_{block, lanes, context, spheres, collisionRadii, roots_},
          deepest_(context.lengthIterations > 0
                       ? static_cast<float>(HAIRLOOM_DEEP_IN_SPHERE * HAIRLOOM_DEEP_IN_SPHERE)
                       : 0.0f) {
        const V step = all(static_cast<float>(context.index + 1));
        for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth)
            store3(load3(lanes.root, lane) + load3(lanes.rootDisplacement, lane) * step, roots_, lane);
    }

    /// With the list of the block, which it makes where there is none that holds; `fromList` is for
    /// isStillNear().
    HWY_INLINE void runListed(float fromList) {
        if (!near_.made || !isStillNear(context_, near_, fromList)) findNear(in_, near_);
        if (!near_.made) return run();
        findTouches({near_.pairs, near_.pairCount});
        touchAll();
    }

    /// Without a list, some points of a strip after the other.
    HWY_INLINE void run() {
        NearPoints::Pair pairs[SphereSet::kMax * kPartPoints + 1];
        forEachPart(block_, [&](std::uint32_t lane, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
            findTouches({pairs, findPairs(in_, lane, begin, end, 0.0f, pairs)});
            touchAll();
            return true;
        });
    }

  private:
    using Touch = NearPoints::Touch;
    static_assert(kMaxPoints * kBlockLanes <= 0x10000);

    HWY_INLINE V3 rootAt(std::size_t i) const { return load3(roots_, i % kBlockLanes); }
    HWY_INLINE float collisionRadiusAt(std::size_t i) const { return collisionRadii_[i / kBlockLanes]; }
    /// Of points with a sphere; of no lanes.
    HWY_INLINE Contact contactOf(std::size_t i, std::size_t sphere) const {
        return {noLane(), spheres_.centre(sphere) - rootAt(i), all3(context_.spheres[sphere].step),
                all(spheres_.radius[sphere] + collisionRadiusAt(i)), zero3()};
    }

    HWY_INLINE void findTouches(std::span<const NearPoints::Pair> pairs) {
        Touch* last = near_.touches;
        for (const NearPoints::Pair& pair : pairs) {
            const std::size_t index = pair.index();
            const V3 centre = spheres_.centre(pair.sphere()) - rootAt(index);
            const V3 back = centre - load3(block_.position, index);
            const std::uint32_t inside = bitsOf(dot(back, back) < all(pair.reachSquared));
            *last = {{pair.which, pair.reachSquared}, inside};
            last += inside != 0 ? 1 : 0;
        }
        touchCount_ = static_cast<std::size_t>(last - near_.touches);
    }

    HWY_INLINE void touchAll() {
        for (std::size_t t = 0; t < touchCount_; ++t) touch(near_.touches[t]);
    }

    HWY_INLINE void touch(Touch found) {
        const std::size_t i = found.pair.index(), sphere = found.pair.sphere();
        Contact contact = contactOf(i, sphere);
        const V3 at = load3(block_.position, i);
        const V3 offset = at - contact.centre;
        const V squared = dot(offset, offset), reachSquared = all(found.pair.reachSquared);
        contact.from = offset;
        if constexpr (kBackward) {
            contact.from =
                backAlong(offset, at - load3(block_.previous, i) - contact.step, squared, contact.reach);
        }
        const auto deep = squared < reachSquared * all(deepest_);
        if (HWY_UNLIKELY(!hn::AllFalse(D(), deep))) {
            const V3 edge = at - load3(block_.position, i - kBlockLanes);
            contact.from = select(deep, acrossStrand(offset, edge), contact.from);
        }
        // A sphere before may have taken the point out of this one.
        contact.touching = hn::And(maskOf(found.inside), squared < reachSquared);
        const V3 placed = respond(block_, context_, i, contact);
        const V3 root = rootAt(i);
        const float collisionRadius = collisionRadiusAt(i);
        auto again = noLane();
        for (std::uint64_t left = overlaps_.of(sphere); left != 0; left &= left - 1) {
            const auto other = static_cast<std::size_t>(std::countr_zero(left));
            const V3 itsOffset = placed - (spheres_.centre(other) - root);
            const V itsReach = all(spheres_.radius[other] + collisionRadius);
            again = hn::Or(again, depthIn(itsOffset, itsReach) > hn::Zero(D()));
        }
        again = hn::And(again, contact.touching);
        if (HWY_UNLIKELY(!hn::AllFalse(D(), again))) settle(found, bitsOf(again));
    }

    /// Lanes of points that left a sphere into others of a union: each goes to the circle that its last
    /// sphere and the one in which it is deepest have in common, until it is free. Places on the surfaces of
    /// two spheres follow in one step; towards a corner of three the rest shrinks from step to step. Makes
    /// the contact anew: touch() need not keep it.
    HWY_NOINLINE void settle(Touch left, std::uint32_t lanes) {
        constexpr int kSteps = 16;
        const std::size_t i = left.pair.index(), sphere = left.pair.sphere();
        const V3 root = rootAt(i);
        const V collisionRadius = all(collisionRadiusAt(i));
        Contact contact = contactOf(i, sphere);
        contact.touching = maskOf(lanes);
        std::uint64_t others = overlaps_.of(sphere) | (std::uint64_t{1} << sphere);
        for (int k = 0; k < kSteps; ++k) {
            const V3 at = load3(block_.position, i);
            V deepest = hn::Zero(D());
            Contact next = contact;
            for (std::uint64_t some = others; some != 0; some &= some - 1) {
                const auto j = static_cast<std::size_t>(std::countr_zero(some));
                const V3 centre = spheres_.centre(j) - root;
                const V reach = all(spheres_.radius[j]) + collisionRadius;
                const V depth = depthIn(at - centre, reach);
                // Of spheres that are equally deep the first counts.
                const auto deeper = depth > deepest;
                deepest = hn::Max(deepest, depth);
                next.centre = select(deeper, centre, next.centre);
                next.step = select(deeper, all3(context_.spheres[j].step), next.step);
                next.reach = hn::IfThenElse(deeper, reach, next.reach);
            }
            next.touching = hn::And(contact.touching, deepest > hn::Zero(D()));
            if (hn::AllFalse(D(), next.touching)) return;
            auto meet = next.touching;
            const V3 onCircle = nearestOfCircle(at, contact, next.centre, next.reach, meet);
            next.from = select(meet, onCircle, at - next.centre);
            contact = next;
            respond(block_, context_, i, contact);
            others = overlaps_.ofAny(others);
        }
    }

    const SpringBlock& block_;
    const SubstepContext& context_;
    const SphereSet& spheres_;
    const float* const collisionRadii_;
    Overlaps overlaps_;
    NearPoints& near_;
    const NearInput in_;
    const float deepest_;  ///< square of HAIRLOOM_DEEP_IN_SPHERE; 0 where no length holds a point back
    alignas(64) float roots_[3][kBlockLanes];
    std::size_t touchCount_ = 0;
};

/// Of spheres of several sets: points that one set leaves in spheres of another go out as Contacts::settle()
/// has it, among all of them.
HWY_NOINLINE void settleSets(const SpringBlock& block, const LaneFrame& lanes, const SubstepContext& context,
                             const float* collisionRadii) {
    constexpr int kSteps = 16;
    const float step = static_cast<float>(context.index + 1);
    const float widest = std::max(context.collisionRadiusAtRoot, context.collisionRadiusAtTip);
    const auto centreOf = [&](const MovingSphere& sphere) { return sphere.from_ws + sphere.step * step; };
    forEachPart(block, [&](std::uint32_t lane, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
        const V3 root = load3(lanes.root, lane) + load3(lanes.rootDisplacement, lane) * all(step);
        WideBox world = WideBox::empty();
        world.add(boxOf(block, lane, begin, end), root);
        const Box box = world.reduced();
        const auto holdsAny = [&](const MovingSphere& sphere) HWY_ATTR {
            const Float3 centre_ws = centreOf(sphere);
            const auto gap = [](float low, float high, float at) {
                return std::fmax(std::fmax(low - at, at - high), 0.0f);
            };
            const Float3 away{gap(box.low.x, box.high.x, centre_ws.x),
                              gap(box.low.y, box.high.y, centre_ws.y),
                              gap(box.low.z, box.high.z, centre_ws.z)};
            const float most = sphere.radius + widest;
            if (dot(away, away) > most * most) return false;
            auto inside = noLane();
            for (std::uint32_t p = begin; p < end; ++p) {
                const V3 at = load3(block.position, std::size_t{p} * kBlockLanes + lane);
                const V depth = depthIn(at + root - all3(centre_ws), all(sphere.radius + collisionRadii[p]));
                inside = hn::Or(inside, depth > hn::Zero(D()));
            }
            return !hn::AllFalse(D(), inside);
        };
        bool isFree = true;
        for (const MovingSphere& sphere : context.spheres) isFree = isFree && !holdsAny(sphere);
        if (HWY_LIKELY(isFree)) return true;
        for (std::uint32_t p = begin; p < end; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            // No circle is common with what is so far away: the first way out is the shortest.
            Contact last{noLane(), all3({1e6f, 0.0f, 0.0f}), zero3(), hn::Zero(D()), zero3()};
            for (int k = 0; k < kSteps; ++k) {
                const V3 at = load3(block.position, i);
                V deepest = hn::Zero(D());
                Contact next = last;
                for (const MovingSphere& sphere : context.spheres) {
                    const V3 centre = all3(centreOf(sphere)) - root;
                    const V reach = all(sphere.radius + collisionRadii[p]);
                    const V depth = depthIn(at - centre, reach);
                    const auto deeper = depth > deepest;
                    deepest = hn::Max(deepest, depth);
                    next.centre = select(deeper, centre, next.centre);
                    next.step = select(deeper, all3(sphere.step), next.step);
                    next.reach = hn::IfThenElse(deeper, reach, next.reach);
                }
                next.touching = deepest > hn::Zero(D());
                if (HWY_LIKELY(hn::AllFalse(D(), next.touching))) break;
                auto meet = next.touching;
                const V3 onCircle = nearestOfCircle(at, last, next.centre, next.reach, meet);
                next.from = select(meet, onCircle, at - next.centre);
                last = next;
                respond(block, context, i, last);
            }
        }
        return true;
    });
}

/// Pushes points, with their collision radius, out of spheres (Eq. 14). Where spheres overlap, a point that
/// one of them pushes into others goes to their common edge. `fromList` is what farthestFromList() says where
/// there is a list.
template <bool kBackward>
HWY_INLINE void collidePoints(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context,
                              float fromList) {
    const float step = static_cast<float>(context.index + 1);
    const float maxCollisionRadius = std::max(context.collisionRadiusAtRoot, context.collisionRadiusAtTip);
    alignas(64) float collisionRadii[kMaxPoints];
    fillCollisionRadii(block, context, collisionRadii);
    SphereSet spheres;
    if (context.spheres.size() <= SphereSet::kMax && block.points <= NearPoints::kMaxPoints) {
        spheres.take(context.spheres, step, maxCollisionRadius);
        Contacts<kBackward>(block, lanes, context, spheres, collisionRadii, springLanes(lanes).near)
            .runListed(fromList);
        return;
    }
    SubstepContext part = context;
    for (std::size_t first = 0; first < context.spheres.size(); first += SphereSet::kMax) {
        part.spheres = context.spheres.subspan(
            first, std::min<std::size_t>(SphereSet::kMax, context.spheres.size() - first));
        spheres.take(part.spheres, step, maxCollisionRadius);
        springLanes(lanes).near.overlapsKnown = 0;
        Contacts<kBackward>(block, lanes, part, spheres, collisionRadii, springLanes(lanes).near).run();
    }
    if (context.spheres.size() > SphereSet::kMax) settleSets(block, lanes, context, collisionRadii);
}

template <bool kBackward>
HWY_INLINE void collideWith(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context,
                            float fromList) {
    collidePoints<kBackward>(block, lanes, context, fromList);
    if (HWY_UNLIKELY(context.segmentsTouch)) collideSegments(block, lanes, context);
}

template <bool kBackward>
void collide(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    const float fromList =
        springLanes(lanes).near.made ? farthestFromList(block, springLanes(lanes).near) : 0.0f;
    collideWith<kBackward>(block, lanes, context, fromList);
}

/// Points of a strip of lanes.
struct Points {
    std::uint32_t begin, end, lane;
};

/// The force of one sphere.
HWY_INLINE void push(const SpringBlock& block, Points points, V3 centre, float radius,
                     const float* collisionRadii, V stiffness) {
    for (std::uint32_t p = points.begin; p < points.end; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + points.lane;
        const V reach = all(radius) + all(collisionRadii[p]);
        const V3 offset = load3(block.position, i) - centre;
        const V squared = dot(offset, offset);
        const auto inside = squared < reach * reach;
        if (HWY_LIKELY(hn::AllFalse(D(), inside))) continue;
        const Direction direction = directionOf(offset);
        const V depth = hn::Max(reach - direction.length, hn::Zero(D()));
        const V3 push = direction.from * (direction.inverse * depth * stiffness);
        // A point just outside keeps its position whatever its neighbours do: rounding makes of its length
        // less than the reach.
        store3(load3(block.previous, i) - select(inside, push, zero3()), block.previous, i);
    }
}

/// Penalty force: a spring of frequency penaltyFrequency from the point to its p_a on each sphere that it is
/// in, as the acceleration ω²·depth along the normal. Stable while ω·h < 2, where one sphere pushes; the
/// squares of the frequencies of spheres that push the same way add.
void applyPenalty(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    // Positions are still those of the substep's start.
    const float step = static_cast<float>(context.index);
    alignas(64) float collisionRadii[kMaxPoints];
    fillCollisionRadii(block, context, collisionRadii);
    const V stiffness = all(context.penaltyStep);
    SphereSet spheres;
    for (std::size_t first = 0; first < context.spheres.size(); first += SphereSet::kMax) {
        spheres.take(context.spheres.subspan(
                         first, std::min<std::size_t>(SphereSet::kMax, context.spheres.size() - first)),
                     step, std::fmax(context.collisionRadiusAtRoot, context.collisionRadiusAtTip));
        forEachPart(block, [&](std::uint32_t lane, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
            const V3 root = load3(lanes.root, lane) + load3(lanes.rootDisplacement, lane) * all(step);
            WideBox world = WideBox::empty();
            world.add(boxOf(block, lane, begin, end), root);
            spheres.forEachMeeting(world.reduced(), 0.0f, [&](std::size_t k) HWY_ATTR {
                push(block, {begin, end, lane}, spheres.centre(k) - root, spheres.radius[k], collisionRadii,
                     stiffness);
            });
            return true;
        });
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
