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

/// The same for a body. A node keeps its radius from it, but no more than its clearance. Nodes that were far
/// off when they were last looked at, and have not come far since, are not looked at.
template <class Visit>
HWY_INLINE void touchBody(const MovingBody& body, V3 root, const RodNode& node, const BlockView& block,
                          std::size_t i, std::uint32_t substep, Visit&& visit) {
    const V3 position_ws = node.position + root;
    const V reach = hn::Min(node.radius, hn::Load(D(), block.clearance + i));
    const V near = reach + hn::Sqrt(dot(node.displacement, node.displacement)) +
                   all(static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR));
    const std::size_t pitch = block.pitch;
    float* const seen = block.bodySeen + i;
    const MovingBody::Carrier& carrier = body.carrier(substep);
    const V3 carried = mad3(all3(carrier.inverse.x), position_ws.x,
                            mad3(all3(carrier.inverse.y), position_ws.y,
                                 mad3(all3(carrier.inverse.z), position_ws.z, all3(carrier.inverse.origin))));
    const V3 since =
        carried - V3{hn::Load(D(), seen), hn::Load(D(), seen + pitch), hn::Load(D(), seen + 2 * pitch)};
    const V used = hn::MulAdd(hn::Sqrt(dot(since, since)), all(carrier.largest), all(carrier.strayed));
    const auto far = used + near < hn::Load(D(), seen + 3 * pitch);
    if (HWY_LIKELY(hn::AllTrue(D(), far))) return;
    alignas(64) float at[3][kWidth], gone[3][kWidth], keeps[kWidth], farthest[kWidth], normal[3][kWidth],
        way[3][kWidth], distance[kWidth], before[kWidth], known[kWidth], place[3][kWidth];
    hn::Store(position_ws.x, D(), at[0]);
    hn::Store(position_ws.y, D(), at[1]);
    hn::Store(position_ws.z, D(), at[2]);
    hn::Store(carried.x, D(), place[0]);
    hn::Store(carried.y, D(), place[1]);
    hn::Store(carried.z, D(), place[2]);
    hn::Store(node.displacement.x, D(), gone[0]);
    hn::Store(node.displacement.y, D(), gone[1]);
    hn::Store(node.displacement.z, D(), gone[2]);
    hn::Store(reach, D(), keeps);
    hn::Store(near, D(), farthest);
    hn::Store(hn::IfThenElseZero(far, all(1.0f)), D(), known);
    std::uint32_t touched = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
        BodyTouch touch{{0.0f, 1.0f, 0.0f}, 1e3f, 1e3f, {}};
        if (known[lane] == 0.0f) {
            float away = 0.0f;
            const BodyVisit how{{at[0][lane], at[1][lane], at[2][lane]},
                                {gone[0][lane], gone[1][lane], gone[2][lane]},
                                keeps[lane],
                                farthest[lane]};
            if (body.touch(substep, how, touch, away)) {
                touched |= 1u << lane;
                away = 0.0f;
            }
            for (std::size_t axis = 0; axis < 3; ++axis) seen[axis * pitch + lane] = place[axis][lane];
            seen[3 * pitch + lane] = away + carrier.strayed;
        }
        distance[lane] = touch.distance;
        before[lane] = touch.before;
        normal[0][lane] = touch.normal.x;
        normal[1][lane] = touch.normal.y;
        normal[2][lane] = touch.normal.z;
        way[0][lane] = touch.way.x;
        way[1][lane] = touch.way.y;
        way[2][lane] = touch.way.z;
    }
    if (HWY_LIKELY(touched == 0)) return;
    const V3 n{hn::Load(D(), normal[0]), hn::Load(D(), normal[1]), hn::Load(D(), normal[2])};
    const V3 moved{hn::Load(D(), way[0]), hn::Load(D(), way[1]), hn::Load(D(), way[2])};
    visit(RodTouch{n, reach - hn::Load(D(), distance), reach - hn::Load(D(), before), moved},
          maskOf(touched));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
