// SPDX-License-Identifier: MIT
// Contacts of rods with spheres: potentials of a node that enter its solve (docs/engine.md, "Contacts").
#if defined(HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H
#undef HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H
#endif

#include "engine/body_free.h"
#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "engine/moving_body.h"
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
#include "models/rods/rod_body-inl.h"
#include "models/rods/rod_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

HWY_INLINE RodContact noContact() {
    RodContact contact;
    for (V& number : contact.hessian) number = hn::Zero(D());
    contact.gradient = contact.normal = zero3();
    contact.twiceEnergy = contact.touching = hn::Zero(D());
    return contact;
}

HWY_INLINE RodContact rodChosen(RodMask which, const RodContact& yes, const RodContact& no) {
    RodContact contact;
    for (int i = 0; i < 6; ++i) contact.hessian[i] = choose(which, yes.hessian[i], no.hessian[i]);
    contact.gradient = select(which, yes.gradient, no.gradient);
    contact.twiceEnergy = choose(which, yes.twiceEnergy, no.twiceEnergy);
    contact.touching = choose(which, yes.touching, no.touching);
    contact.normal = select(which, yes.normal, no.normal);
    return contact;
}

/// Calls visit(touch, near) for each shape that is near the node in some lane; `root` is where its root is at
/// the end of the substep. Other lanes are outside of the shape, and were.
template <class Visit>
HWY_INLINE void forEachTouch(const LaneFrame& lanes, V3 root, const RodNode& node,
                             const SubstepContext& context, Visit&& visit) {
    const V3 position_ws = node.position + root;
    const V away = hn::Sqrt(dot(node.displacement, node.displacement)) + node.radius;
    for (const MovingSphere& sphere : lanes.touchable) {
        const Float3 centre_ws = sphere.from_ws + sphere.step * static_cast<float>(context.index + 1);
        const V3 to = position_ws - all3(centre_ws);
        // By far more than rounding most nodes are neither inside a sphere nor come out of one or past it.
        const V farthest = away + all(1.001f * (sphere.radius + sphere.stepLength) +
                                      static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR));
        const auto near = dot(to, to) <= farthest * farthest;
        if (HWY_LIKELY(hn::AllFalse(D(), near))) continue;
        visit(rodTouchSphere(node, all3(centre_ws) - root, all3(sphere.step), all(sphere.radius),
                             context.sweeps),
              near);
    }
}

/// A body that comes fast is many times as deep in a strand as what one step can turn: it pushes by so many
/// metres a step, in so many steps at most, until no node is deeper than so many metres.
constexpr float kBodyPush = 8e-3f;
constexpr int kBodyLooks = 10;
constexpr float kBodyDeep = 1e-3f;

/// The plane that stands for a body in a substep, for a node of each lane, and where it was looked at.
struct BodyPlane {
    V3 at;  ///< the node, relative to its root
    V3 normal;
    V distance;  ///< metres, there
    V before;
    V3 way;
    V known;   ///< 1 where it is of this substep
    V room;    ///< metres that the node may go and touch nothing, beyond the displacement
    V3 moved;  ///< that it had when it was last seen in this substep
};

/// Nothing is known of it yet.
HWY_INLINE void forgetPlane(BodyPlane& plane) {
    plane.at = plane.normal = plane.way = plane.moved = zero3();
    plane.distance = plane.before = plane.known = plane.room = hn::Zero(D());
}

/// How nodes of a body's skin are seen: bodySeen of a node of each lane.
struct BodySeen {
    V3 place;  ///< in the space of the carrier
    V carried, other, number;

    BodySeen(const float* at, std::size_t pitch)
        : place(load3(at, pitch)),
          carried(hn::Load(D(), at + 3 * pitch)),
          other(hn::Load(D(), at + 4 * pitch)),
          number(hn::Load(D(), at + 5 * pitch)) {}
    void store(float* at, std::size_t pitch) const {
        store3(place, at, pitch);
        hn::Store(carried, D(), at + 3 * pitch);
        hn::Store(other, D(), at + 4 * pitch);
        hn::Store(number, D(), at + 5 * pitch);
    }
};

/// Looks for lanes whose plane does not hold; gives back all that meet one.
HWY_NOINLINE RodMask lookAtBody(const MovingBody& body, V3 position_ws, V reach, const RodNode& node,
                                const BlockView& block, std::size_t i, std::uint32_t substep, RodMask kept,
                                BodyPlane& plane) {
    constexpr auto kDeep = static_cast<float>(HAIRLOOM_ROD_CONTACT_DEEP);
    const V margin = reach + all(static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR));
    BodySeen seen(block.bodySeen + i, block.pitch);
    LaneCarrier carrier = carrierOfLanes(body.carriers(substep), seen.number);
    V3 place = carrier.inverse.apply(position_ws);
    const V3 start_ws = position_ws - node.displacement;
    // On its way through the substep no node is farther from where it was looked at than at one of its ends.
    V3 since = place - seen.place, sinceStart = carrier.inverseBefore.apply(start_ws) - seen.place;
    V used = hn::Sqrt(hn::Max(dot(since, since), dot(sinceStart, sinceStart))) * carrier.largest;
    V carried = seen.carried - used, other = seen.other - (used + carrier.strayed);
    const auto far = both(both(carried > margin, other > margin), carrier.usable);
    const auto searched = hn::Not(either(kept, far));
    plane.room = (hn::Min(carried, other) - reach) * carrier.least;
    plane.moved = node.displacement;
    if (HWY_LIKELY(hn::AllFalse(D(), searched))) return kept;

    // How each comes against its carrier.
    V3 way = position_ws - carrier.before.apply(place);
    V3 against = node.displacement - way;
    V near = margin + hn::Sqrt(dot(against, against));
    const bool isWhole = body.isWhole(substep);
    const auto ownOnly = isWhole ? carrier.usable : both(carrier.usable, other > near);
    BodySample sample = sampleBody(body.field(), body.table(), place);
    const auto isOwn = [&] {
        return isWhole ? sample.inside : hn::And(sample.inside, sample.bone == carrier.bone);
    };
    // Skin of others is farther away than `near`.
    auto lone = both(both(searched, ownOnly), either(isOwn(), both(sample.inside, sample.distance > near)));
    auto met = noLane();
    const auto looked = hn::AndNot(lone, searched);
    if (!hn::AllFalse(D(), looked)) {
        const LaneLook found = lookOfLanes(body, substep, position_ws, node.displacement, margin, looked);
        met = found.met;
        plane.normal = select(met, found.normal, plane.normal);
        plane.way = select(met, found.way, plane.way);
        plane.distance = choose(met, found.distance, plane.distance);
        plane.before = choose(met, found.before, plane.before);
        carried = choose(looked, found.carried, carried);
        other = choose(looked, found.other, other);
        const V numbers = choose(looked, found.number, carrier.number);
        if (!hn::AllFalse(D(), numbers != carrier.number)) {
            carrier = carrierOfLanes(body.carriers(substep), numbers);
            place = select(looked, carrier.inverse.apply(position_ws), place);
            way = position_ws - carrier.before.apply(place);
            against = node.displacement - way;
            near = choose(looked, margin + hn::Sqrt(dot(against, against)), near);
            if (!hn::AllFalse(D(), found.isCarried)) sample = sampleBody(body.field(), body.table(), place);
        }
        lone = either(lone, found.isCarried);
    }
    if (!hn::AllFalse(D(), lone)) {
        const V3 g = sample.gradient;
        const V3 gradient{dot(carrier.inverse.x, g), dot(carrier.inverse.y, g), dot(carrier.inverse.z, g)};
        const V slope = hn::Sqrt(dot(gradient, gradient)), inverse = all(1.0f) / slope;
        const auto sloped = both(sample.inside, slope > all(1e-3f));
        const V distance = sample.distance * (hn::Sqrt(dot(g, g)) * inverse);
        const V3 normal = gradient * inverse;
        const V fine = choose(distance < all(BodyField::kFineReach), all(kBodyUnsureFine), all(kBodyUnsure));
        const V free = mad(all(kBodySure), distance, negMad(fine, all(body.cell()), hn::Zero(D())));
        const auto told = both(lone, sloped);
        carried = choose(told, hn::Max(carried, free), carried);
        other = isWhole ? choose(told, hn::Max(other, free), other) : other;
        const auto here = both(told, distance <= near + carrier.apart);
        const V before = distance - dot(normal, against);
        plane.normal = select(here, normal, plane.normal);
        plane.way = select(here, way, plane.way);
        plane.distance = choose(here, distance, plane.distance);
        plane.before = choose(here, before, plane.before);
        met = either(met, here);
    }
    const std::uint32_t swept = bitsOf(both(met, plane.before < reach - all(kDeep)));
    if (HWY_UNLIKELY(swept != 0)) {
        const SplitLanes at(position_ws), moved(node.displacement), ways(plane.way);
        const Lanes1 keeps(reach), nears(near + carrier.apart);
        SplitLanes normals(plane.normal);
        Lanes1 distances(plane.distance), befores(plane.before);
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            if ((swept >> lane & 1u) == 0) continue;
            BodyTouch touch{normals[lane], distances.at[lane], befores.at[lane], ways[lane]};
            body.sweep(substep, {at[lane], moved[lane], keeps.at[lane]}, nears.at[lane], touch);
            normals.set(lane, touch.normal);
            distances.at[lane] = touch.distance;
            befores.at[lane] = touch.before;
        }
        plane.normal = normals.all();
        plane.distance = distances.all();
        plane.before = befores.all();
    }
    // Lanes that were searched are known from where they are now.
    seen.place = select(searched, place, seen.place);
    seen.carried = choose(searched, carried, seen.carried);
    seen.other = choose(searched, other + carrier.strayed, seen.other);
    seen.number = choose(searched, carrier.number, seen.number);
    seen.store(block.bodySeen + i, block.pitch);
    plane.at = select(searched, node.position, plane.at);
    plane.known = choose(searched, hn::IfThenElseZero(met, all(1.0f)), plane.known);
    plane.room = choose(searched, (hn::Min(carried, other) - reach) * carrier.least, plane.room);
    return either(kept, met);
}

/// The same for a body. A node keeps its radius from it, but no more than its clearance.
/// Nodes that were far off when they were last looked at, and have not come far since, are not looked at. In
/// a substep the plane that was found holds for all guesses that are close to where it was found, and for
/// those that are outside for certain. Where all that is near hangs on one bone, it is looked up at rest, all
/// lanes at once; what else there is, lookOfLanes() finds.
template <class Visit>
HWY_INLINE void touchBody(const MovingBody& body, V3 root, const RodNode& node, const BlockView& block,
                          std::size_t i, std::uint32_t substep, BodyPlane& plane, Visit&& visit) {
    const V reach = hn::Min(node.radius, hn::Load(D(), block.clearance + i));
    const V3 from = node.position - plane.at;
    const V gone = hn::Sqrt(dot(from, from));
    constexpr float kClose = 1e-4f, kClearly = 1e-4f;  // metres
    const auto outside = negMad(gone, all(1.25f), plane.distance) > reach + all(kClearly);
    auto meets = both(plane.known > hn::Zero(D()), either(gone <= all(kClose), outside));
    if (HWY_UNLIKELY(!hn::AllTrue(D(), meets)))
        meets = lookAtBody(body, node.position + root, reach, node, block, i, substep, meets, plane);
    if (HWY_LIKELY(hn::AllFalse(D(), meets))) return;
    const V farOutside = all(-1e3f);
    const V distance = plane.distance + dot(node.position - plane.at, plane.normal);
    visit(RodTouch{plane.normal, choose(meets, hn::Min(reach - distance, all(kBodyPush)), farOutside),
                   choose(meets, reach - plane.before, farOutside), plane.way},
          meets);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
