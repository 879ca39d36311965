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
#include "engine/spheres-inl.h"
#include "hwy/highway.h"
#include "models/rods/rod_math-inl.h"
#include "models/rods/rod_search-inl.h"

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

/// Calls visit(touch, near) for each sphere and capsule that is near the node in some lane; `root` is where
/// its root is at the end of the substep. Other lanes are outside of the shape, and were.
template <class Visit>
HWY_INLINE void forEachTouch(const LaneFrame& lanes, V3 root, const RodNode& node,
                             const SubstepContext& context, Visit&& visit) {
    const V3 position_ws = node.position + root;
    const V moved = hn::Sqrt(dot(node.displacement, node.displacement)), away = moved + node.radius;
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
    for (const MovingCapsule& capsule : lanes.touchableCapsules) {
        const MovingSphere& around = capsule.around;
        const auto substeps = static_cast<float>(context.index + 1);
        const V3 to = position_ws - all3(around.from_ws + around.step * substeps);
        const V margin = all(static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR)), more = all(1.001f);
        const V farthest = away + (more * all(around.radius + around.stepLength) + margin);
        if (HWY_LIKELY(hn::AllFalse(D(), dot(to, to) <= farthest * farthest))) continue;
        const RodCapsule shape = capsuleOf(capsule, substeps);
        RodCapsuleSphere sphere = rodCapsuleNearest(shape, position_ws);
        // A way, less that of the capsule, is no longer than both together.
        const V way = moved + all(around.stepLength);
        if (context.sweeps && !hn::AllFalse(D(), more * way > all(kUnsweptShare) * shape.thinnest))
            sphere = rodCapsuleMet(shape, position_ws, node.displacement, node.radius, sphere);
        const V3 off = position_ws - sphere.centre;
        const V reach = away + (more * (sphere.radius + hn::Sqrt(dot(sphere.step, sphere.step))) + margin);
        const auto near = dot(off, off) <= reach * reach;
        if (hn::AllFalse(D(), near)) continue;
        visit(rodTouchSphere(node, sphere.centre - root, sphere.step, sphere.radius, context.sweeps), near);
    }
}

constexpr float kAnyDepth = 1e9f;  ///< metres

constexpr auto kBodyPush = static_cast<float>(HAIRLOOM_BODY_PUSH);
constexpr auto kBodyDeep = static_cast<float>(HAIRLOOM_BODY_DEEP);

/// Metres by which a prediction may lift a node off what pressed it in the last substep. Skin has folds and
/// edges: what one substep presses a node against, the next may not meet, and the node falls back by more
/// than it was lifted.
HWY_INLINE V bodySlackAfter(const RodTouch& touch, const RodNode& node) {
    const V slack = rodSlackAfter(node.load);
    const V back = hn::Min(hn::Abs(node.load) * all(static_cast<float>(HAIRLOOM_BODY_BACK)) / node.weight,
                           all(static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR)));
    const auto wasThere = touch.before > all(-static_cast<float>(HAIRLOOM_ROD_CONTACT_DEEP));
    return choose(wasThere, hn::Max(slack, back), slack);
}

/// Whether a node goes back and forth in slow substeps of h seconds. Across an edge of skin it could do so
/// for ever.
HWY_INLINE RodMask goesBack(V3 moved, V3 last, float h) {
    const V slow = all(static_cast<float>(HAIRLOOM_ROD_CONTACT_SLOW) * h);
    const V most = hn::Max(dot(moved, moved), dot(last, last));
    return both(most < slow * slow, dot(moved, last) < all(-0.5f) * most);
}

constexpr auto kFoldReach = static_cast<float>(HAIRLOOM_BODY_FOLD_REACH);

/// The same for a body, by the plane that BodySearch has found, and by the other one where skin folds. A node
/// keeps its radius from them, but no more than its clearance.
template <class Visit>
HWY_INLINE void touchBody(const RodNode& node, const BlockView& block, std::size_t i, const BodyPlane& plane,
                          Visit&& visit) {
    const auto meets = plane.meets > hn::Zero(D());
    if (HWY_LIKELY(hn::AllFalse(D(), meets))) return;
    const V reach = bodyReach(node.radius, block, i), farOutside = all(-1e3f);
    const V distance = plane.distance + dot(node.position - plane.at, plane.normal);
    visit(RodTouch{plane.normal, choose(meets, hn::Min(reach - distance, all(kBodyPush)), farOutside),
                   choose(meets, reach - plane.before, farOutside), plane.way},
          meets);
    const V3 n = plane.otherNormal;
    const auto folds = both(both(meets, dot(n, n) > hn::Zero(D())), distance < reach + all(kFoldReach));
    if (HWY_LIKELY(hn::AllFalse(D(), folds))) return;
    const V other = plane.otherLevel + dot(n, node.displacement);
    const V otherBefore = plane.otherLevel + dot(n, plane.way);
    visit(RodTouch{onlyWhere(folds, n), choose(folds, hn::Min(reach - other, all(kBodyPush)), farOutside),
                   choose(folds, reach - otherBefore, farOutside), plane.way},
          folds);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
