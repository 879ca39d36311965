// SPDX-License-Identifier: MIT
// Contacts of rods with spheres: potentials of a node that enter its solve (docs/engine.md, "Contacts").
#if defined(HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H
#undef HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_CONTACT_INL_H
#endif

#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "engine/moving_body.h"
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
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

/// The same for a body. A node keeps its radius from it, but no more than its clearance.
/// Nodes that were far off when they were last looked at, and have not come far since, are not looked at. In
/// a substep the plane that was found holds for all guesses that are close to where it was found, and for
/// those that are outside for certain.
template <class Visit>
HWY_INLINE void touchBody(const MovingBody& body, V3 root, const RodNode& node, const BlockView& block,
                          std::size_t i, std::uint32_t substep, BodyPlane& plane, Visit&& visit) {
    constexpr float kClose = 1e-4f, kClearly = 1e-4f;  // metres
    const V3 position_ws = node.position + root;
    const V reach = hn::Min(node.radius, hn::Load(D(), block.clearance + i));
    const V3 from = node.position - plane.at;
    const V gone = hn::Sqrt(dot(from, from));
    const auto outside = negMad(gone, all(1.25f), plane.distance) > reach + all(kClearly);
    const auto kept = both(plane.known > hn::Zero(D()), either(gone <= all(kClose), outside));
    auto meets = kept;
    const MovingBody::Carrier& carrier = body.carrier(substep);
    // How far it comes against the body in this substep.
    const V3 start_ws = position_ws - node.displacement;
    const BonePose& step = carrier.step;
    const V3 against = node.displacement - mad3(all3(step.x), start_ws.x,
                                                mad3(all3(step.y), start_ws.y,
                                                     mad3(all3(step.z), start_ws.z, all3(step.origin))));
    const V near =
        reach + hn::Sqrt(dot(against, against)) + all(static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR));
    const std::size_t pitch = block.pitch;
    float* const seen = block.bodySeen + i;
    const V3 carried = mad3(all3(carrier.inverse.x), position_ws.x,
                            mad3(all3(carrier.inverse.y), position_ws.y,
                                 mad3(all3(carrier.inverse.z), position_ws.z, all3(carrier.inverse.origin))));
    struct Rooms {
        V carried, other;
    };
    const auto roomLeft = [&] {
        const V3 since =
            carried - V3{hn::Load(D(), seen), hn::Load(D(), seen + pitch), hn::Load(D(), seen + 2 * pitch)};
        const V used = hn::Sqrt(dot(since, since)) * all(carrier.largest);
        return Rooms{hn::Load(D(), seen + 3 * pitch) - used,
                     hn::Load(D(), seen + 4 * pitch) - (used + all(carrier.strayed))};
    };
    Rooms room = roomLeft();
    const auto far = both(room.carried > near, room.other > near + all(carrier.apart));
    const std::uint32_t looked = bitsOf(hn::Not(either(kept, far)));
    if (looked != 0) {
        alignas(64) float at[3][kWidth], moved[3][kWidth], keeps[kWidth], farthest[kWidth], place[3][kWidth],
            normal[3][kWidth], way[3][kWidth], distance[kWidth], before[kWidth];
        const auto put = [](V3 v, float(*to)[kWidth]) {
            hn::Store(v.x, D(), to[0]);
            hn::Store(v.y, D(), to[1]);
            hn::Store(v.z, D(), to[2]);
        };
        const auto get = [](const float(*from_)[kWidth]) {
            return V3{hn::Load(D(), from_[0]), hn::Load(D(), from_[1]), hn::Load(D(), from_[2])};
        };
        put(position_ws, at);
        put(node.displacement, moved);
        put(carried, place);
        put(plane.normal, normal);
        put(plane.way, way);
        hn::Store(reach, D(), keeps);
        hn::Store(near, D(), farthest);
        hn::Store(plane.distance, D(), distance);
        hn::Store(plane.before, D(), before);
        std::uint32_t met = 0;
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            if ((looked >> lane & 1u) == 0) continue;
            BodyTouch touch{{0.0f, 1.0f, 0.0f}, 0.0f, 0.0f, {}};
            BodyRoom around;
            const BodyVisit how{{at[0][lane], at[1][lane], at[2][lane]},
                                {moved[0][lane], moved[1][lane], moved[2][lane]},
                                keeps[lane],
                                farthest[lane],
                                carrier.apart};
            if (body.touch(substep, how, touch, around)) met |= 1u << lane;
            for (std::size_t axis = 0; axis < 3; ++axis) seen[axis * pitch + lane] = place[axis][lane];
            seen[3 * pitch + lane] = around.carried;
            seen[4 * pitch + lane] = around.other + carrier.strayed;
            distance[lane] = touch.distance;
            before[lane] = touch.before;
            normal[0][lane] = touch.normal.x;
            normal[1][lane] = touch.normal.y;
            normal[2][lane] = touch.normal.z;
            way[0][lane] = touch.way.x;
            way[1][lane] = touch.way.y;
            way[2][lane] = touch.way.z;
        }
        const auto fresh = maskOf(looked);
        plane.at = select(fresh, node.position, plane.at);
        plane.normal = get(normal);
        plane.way = get(way);
        plane.distance = hn::Load(D(), distance);
        plane.before = hn::Load(D(), before);
        plane.known = choose(fresh, hn::IfThenElseZero(maskOf(met), all(1.0f)), plane.known);
        meets = either(meets, maskOf(met));
        room = roomLeft();
    }
    plane.room = (hn::Min(room.carried, room.other) - reach) * all(carrier.least);
    plane.moved = node.displacement;
    if (HWY_LIKELY(hn::AllFalse(D(), meets))) return;
    const V farOutside = all(-1e3f);
    const V distance = plane.distance + dot(node.position - plane.at, plane.normal);
    visit(RodTouch{plane.normal, choose(meets, reach - distance, farOutside),
                   choose(meets, reach - plane.before, farOutside), plane.way},
          meets);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
