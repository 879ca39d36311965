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

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
