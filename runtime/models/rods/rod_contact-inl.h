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

/// The contacts of a node: ½ c + g·x + ½ xᵀH x in its displacement x beyond the predicted one.
struct RodContact {
    V hessian[6];  ///< xx, xy, xz, yy, yz, zz
    V3 gradient;
    V twiceEnergy;
    V touching;  ///< 1 where there is any, 2 where friction gives way at one
    V3 normal;   ///< sum of their normals

    HWY_INLINE V3 times(V3 x) const {
        return {mad(hessian[0], x.x, mad(hessian[1], x.y, hessian[2] * x.z)),
                mad(hessian[1], x.x, mad(hessian[3], x.y, hessian[4] * x.z)),
                mad(hessian[2], x.x, mad(hessian[4], x.y, hessian[5] * x.z))};
    }
    HWY_INLINE V twiceEnergyAt(V3 x) const { return twiceEnergy + dot(gradient + gradient + times(x), x); }
    /// Force of the contacts on the node.
    HWY_INLINE V3 force(V3 x) const { return zero3() - gradient - times(x); }

    /// ½ k (depth − n·x)², which keeps the node out, and ½ g |T (slip + x)|², which holds it back along the
    /// surface.
    HWY_INLINE void add(V k, V g, V3 n, V depth, V3 slip) {
        const V across = k - g;
        const V3 nn = n * across;
        hessian[0] = hessian[0] + mad(nn.x, n.x, g);
        hessian[1] = mad(nn.x, n.y, hessian[1]);
        hessian[2] = mad(nn.x, n.z, hessian[2]);
        hessian[3] = hessian[3] + mad(nn.y, n.y, g);
        hessian[4] = mad(nn.y, n.z, hessian[4]);
        hessian[5] = hessian[5] + mad(nn.z, n.z, g);
        const V push = k * depth;
        gradient = gradient + negMad3(n, push, slip * g);
        twiceEnergy = twiceEnergy + mad(push, depth, g * dot(slip, slip));
    }
};

/// What a node is and does in this substep.
struct RodNode {
    V3 position;      ///< predicted, relative to the root at the end of the substep
    V3 displacement;  ///< predicted, world
    V3 tangent;       ///< predicted, of the segment before it, world
    V3 velocity;      ///< of the last substep, world
    V weight;         ///< m/(h² D)
    V load;           ///< force of its contacts in the last substep; negative where it slid
    V step;           ///< seconds of the time scheme
    float radius;     ///< metres that it keeps from spheres
};

HWY_INLINE void meetSphere(const MovingSphere& sphere, Float3 centre_ws, V3 root, const RodNode& node,
                           const SubstepContext& context, RodContact& contact) {
    const V3 step = all3(sphere.step);
    const V reach = all(sphere.radius + node.radius);
    const V3 to = node.position - (all3(centre_ws) - root);
    const V squared = dot(to, to);
    const V distance = hn::Sqrt(hn::Max(squared, all(1e-18f)));
    V3 n = to * (all(1.0f) / distance);
    V depth = reach - distance;
    const V3 moved = node.displacement - step, from = to - moved;
    const V c = mad(reach, hn::Neg(reach), dot(from, from));
    const auto deep = distance < reach * all(static_cast<float>(HAIRLOOM_DEEP_IN_SPHERE));
    if (HWY_UNLIKELY(!hn::AllFalse(D(), deep))) {
        const V3 across = acrossStrand(to, node.tangent);
        const V3 out = across * (all(1.0f) / hn::Sqrt(hn::Max(dot(across, across), all(1e-18f))));
        const V along = dot(to, node.tangent);
        const V surface = hn::Sqrt(hn::Max(negMad(along, along, reach * reach), hn::Zero(D())));
        n = select(deep, out, n);
        depth = hn::IfThenElse(deep, surface - dot(out, to), depth);
    }
    // What a contact holds is inside by a little, and stays held while the prediction lifts it off.
    const V touches = hn::IfThenElse(hn::Abs(node.load) > hn::Zero(D()),
                                     all(-static_cast<float>(HAIRLOOM_ROD_CONTACT_REACH)), hn::Zero(D()));
    auto held = hn::Or(depth > touches, c < hn::Zero(D()));
    if (context.sweeps) {
        // What would pass the sphere meets it where it comes in.
        const V a = dot(moved, moved), b = dot(from, moved);
        const V discriminant = negMad(a, c, b * b);
        const V first =
            (hn::Neg(b) - hn::Sqrt(hn::Max(discriminant, hn::Zero(D())))) / hn::Max(a, all(1e-30f));
        const auto enters = hn::And(hn::And(c >= hn::Zero(D()), discriminant > hn::Zero(D())),
                                    hn::And(first >= hn::Zero(D()), first < all(1.0f)));
        const V3 entry = mad3(moved, first, from) * (all(1.0f) / reach);
        n = select(enters, entry, n);
        depth = hn::IfThenElse(enters, reach - dot(entry, to), depth);
        held = hn::Or(held, enters);
    }
    if (hn::AllFalse(D(), held)) return;
    const V approach = dot(n, step * all(1.0f / context.h) - node.velocity);
    depth = mad(hn::Max(approach, hn::Zero(D())) * node.step, all(context.restitution), depth);
    const V k = hn::IfThenElseZero(held, node.weight * all(static_cast<float>(HAIRLOOM_ROD_CONTACT)));
    // Coulomb, with the force of the last substep and at most what stops the node. What was stuck has hardly
    // moved: where it gives way it slides by what the force beyond friction does to its own mass.
    const V3 slip = negMad3(n, dot(n, moved), moved);
    const V size = hn::Sqrt(dot(slip, slip)), most = hn::Abs(node.load) * all(context.friction);
    const V excess = hn::Max(hn::MulSub(k, size, most), hn::Zero(D())) / node.weight;
    const V slid = hn::IfThenElse(node.load < hn::Zero(D()), size, hn::Max(size, excess));
    const V grip = hn::Min(most / hn::Max(slid, all(1e-12f)), k);
    contact.add(k, hn::IfThenElseZero(held, grip), n, depth, slip);
    contact.normal = contact.normal + onlyWhere(held, n);
    const V how = hn::IfThenElse(grip < k, all(2.0f), all(1.0f));
    contact.touching = hn::IfThenElse(held, hn::Max(contact.touching, how), contact.touching);
}

/// Of all spheres that the block can touch.
HWY_INLINE RodContact contactOf(const LaneFrame& lanes, V3 root, const RodNode& node,
                                const SubstepContext& context) {
    RodContact contact;
    for (V& number : contact.hessian) number = hn::Zero(D());
    contact.gradient = contact.normal = zero3();
    contact.twiceEnergy = contact.touching = hn::Zero(D());
    // Most nodes are neither inside a sphere nor come out of one or past it, by far more than rounding.
    const V3 position_ws = node.position + root;
    const V displacement = hn::Sqrt(dot(node.displacement, node.displacement));
    for (const MovingSphere& sphere : lanes.touchable) {
        const Float3 centre_ws = sphere.from_ws + sphere.step * static_cast<float>(context.index + 1);
        const V3 to = position_ws - all3(centre_ws);
        const V farthest = displacement + all(1.001f * (sphere.radius + node.radius + sphere.stepLength) +
                                              static_cast<float>(HAIRLOOM_ROD_CONTACT_REACH));
        if (HWY_LIKELY(hn::AllTrue(D(), dot(to, to) > farthest * farthest))) continue;
        meetSphere(sphere, centre_ws, root, node, context, contact);
    }
    return contact;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
