// SPDX-License-Identifier: MIT
// Contacts of rods where a step has led, which its prediction did not have.
#if defined(HAIRLOOM_RUNTIME_ROD_LOOK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_LOOK_INL_H
#undef HAIRLOOM_RUNTIME_ROD_LOOK_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_LOOK_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/rods/rod-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// What the shapes that `holds` names do to a node.
template <bool kBends, bool kTwists, bool kContacts>
template <class Holds>
RodContact RodStrip<kBends, kTwists, kContacts>::contactOf(V3 root, const RodNode& node, std::uint32_t p,
                                                           RodMask near, const Holds& holds) {
    V deepest = all(-kAnyDepth);
    const RodContact found =
        pressedBy(root, node, p, near, all(context_.friction), [&](const RodTouch& touch, RodMask here) {
            const auto held = holds(touch, here);
            deepest = choose(held, hn::Max(deepest, touch.depth), deepest);
            return held;
        });
    // Folds of skin hold by several planes in turn: what presses there twice calms it.
    const RodMask several = rodPressAlike(found) > all(1.0f);
    if (context_.body || HWY_LIKELY(hn::AllFalse(D(), several))) return found;
    return rodChosen(several, pressedBySeveral(root, node, p, near, hn::Min(deepest, hn::Zero(D())), holds),
                     found);
}

template <bool kBends, bool kTwists, bool kContacts>
template <class Holds>
RodContact RodStrip<kBends, kTwists, kContacts>::pressedBy(V3 root, const RodNode& node, std::uint32_t p,
                                                           RodMask near, V friction, const Holds& holds) {
    RodContact found = noContact();
    forEachShape(root, node, p, near, [&](const RodTouch& touch, RodMask here) {
        press(touch, holds(touch, here), node, friction, found);
    });
    return found;
}

/// Of shapes that press alike, as two capsules do at the end that they share: one that another keeps the node
/// off does not hold it back, and friction is by the force of all of them together.
template <bool kBends, bool kTwists, bool kContacts>
template <class Holds>
HWY_NOINLINE RodContact RodStrip<kBends, kTwists, kContacts>::pressedBySeveral(V3 root, const RodNode& node,
                                                                               std::uint32_t p, RodMask near,
                                                                               V least, const Holds& holds) {
    const auto deep = [&](const RodTouch& touch, RodMask here) {
        return both(holds(touch, here), touch.depth >= least);
    };
    const V friction = all(context_.friction);
    const RodContact found = pressedBy(root, node, p, near, friction, deep);
    const V alike = rodPressAlike(found);
    if (hn::AllTrue(D(), alike <= all(1.0f))) return found;
    return pressedBy(root, node, p, near, friction / alike, deep);
}

/// Lanes whose outer node of segment j is near a shape, or has come there since it was last seen.
template <bool kBends, bool kTwists, bool kContacts>
RodMask RodStrip<kBends, kTwists, kContacts>::mayTouch(std::uint32_t j) const {
    const RodPoint& point = points_[j];
    const auto near = point.near > hn::Zero(D());
    if (!context_.body) return near;
    const V3 x = point.newDisplacement - planes_[j].moved;
    const V room = hn::IfThenElseZero(planes_[j].room > hn::Zero(D()), planes_[j].room);
    return either(near, dot(x, x) > room * room);
}

template <bool kBends, bool kTwists, bool kContacts>
bool RodStrip<kBends, kTwists, kContacts>::anyMayTouch() const {
    if (!hn::AllFalse(D(), near_)) return true;
    if (!context_.body) return false;
    auto any = noLane();
    for (std::uint32_t j = first_; j < segments_; ++j) any = either(any, mayTouch(j));
    return !hn::AllFalse(D(), any);
}

/// Calls visit(point, node, p, lanes) for the outer node of each segment where the step has led, for
/// lanes that may touch there.
template <bool kBends, bool kTwists, bool kContacts>
template <class Visit>
void RodStrip<kBends, kTwists, kContacts>::forEachNode(Visit&& visit) {
    V3 position = zero3();
    if (block_.firstFree > 1) position = rodRotate(inner_, restTangent(0)) * lengthOf(0);
    for (std::uint32_t j = first_; j < segments_; ++j) {
        RodPoint& point = points_[j];
        const V3 tangent = rodRotate(loadRotation(rod_.rotation, at(j)), restTangent(j));
        position = mad3(tangent, lengthOf(j), position);
        const auto lanes = mayTouch(j);
        if (!hn::AllFalse(D(), lanes))
            visit(point, nodeOf(point, point.newDisplacement, tangent, position, j + 1), j + 1, lanes);
    }
}

/// Finds the body where the prediction has nodes.
template <bool kBends, bool kTwists, bool kContacts>
void RodStrip<kBends, kTwists, kContacts>::searchPrediction() {
    BodySearch search = bodySearch();
    const V3 root = rootPosition();
    for (std::uint32_t j = first_; j < segments_; ++j) {
        const RodPoint& point = points_[j];
        search.add(root, point.position, point.displacement, all(radiusOf(j + 1)), j + 1, hn::Not(noLane()));
    }
    search.finish();
}

/// Finds the body where the step has led, for nodes that may touch there, which are near from now on.
template <bool kBends, bool kTwists, bool kContacts>
void RodStrip<kBends, kTwists, kContacts>::searchStep() {
    BodySearch search = bodySearch();
    const V3 root = rootPosition();
    forEachNode([&](RodPoint& point, const RodNode& node, std::uint32_t p, RodMask lanes) {
        point.near = choose(lanes, all(1.0f), point.near);
        search.add(root, node.position, node.displacement, node.radius, p, lanes);
    });
    search.finish();
}

/// Looks for contacts where the step has led. Where it has pressed a node into a shape that the
/// prediction had outside, or holds one that it has lifted off, what it has found is the next guess;
/// false: nowhere. Looks after the first are for hair that comes to rest: one step leaves what it has
/// turned far a little inside, the next pushes it out, and what that takes for motion lifts it off after
/// that.
template <bool kBends, bool kTwists, bool kContacts>
bool RodStrip<kBends, kTwists, kContacts>::lookAgain(int look) {
    if (HWY_LIKELY(!anyMayTouch())) return false;
    if (context_.body) searchStep();
    const V3 root = rootPosition();
    const bool isFirst = look == 0, isDeepOnly = look >= HAIRLOOM_ROD_CONTACT_LOOKS;
    const V reach = all(static_cast<float>(HAIRLOOM_ROD_CONTACT_LOOK));
    // The skin has more curves than spheres have: all looks are for whatever they find.
    const bool restsOnly = !isFirst && !context_.body;
    // What it holds may be deeper than one step turns.
    const V deepest = all(context_.body ? kBodyDeep
                          : restsOnly   ? static_cast<float>(HAIRLOOM_ROD_CONTACT_SUNK)
                                        : kAnyDepth);
    auto wrong = noLane();
    V farthest = hn::Zero(D());  // squared, of where a node has gone
    forEachNode([&](RodPoint& point, const RodNode& node, std::uint32_t p, RodMask lanes) {
        const auto held = point.contact.touching > hn::Zero(D());
        const V slack = rodSlackOf(point.contact, point.newDisplacement - point.displacement);
        auto inside = noLane(), lifted = both(held, slack == hn::Zero(D()));
        forEachShape(root, node, p, point.near > hn::Zero(D()), [&](const RodTouch& touch, RodMask) {
            inside =
                either(inside, touch.depth > (isDeepOnly ? all(kBodyDeep) : choose(held, deepest, reach)));
            lifted = hn::AndNot(rodHolds(touch, reach), lifted);
        });
        wrong = either(wrong, both(lanes, isDeepOnly ? inside : either(lifted, inside)));
        farthest = hn::Max(farthest, hn::IfThenElseZero(lanes, dot(node.displacement, node.displacement)));
    });
    if (restsOnly) {
        // What bounces is led off the surface, and what is fast has no end in sight.
        const V slow = all(static_cast<float>(HAIRLOOM_ROD_CONTACT_SLOW) * context_.h);
        wrong = hn::AndNot(either(touched_ > all(2.0f), farthest > slow * slow), wrong);
    }
    // A strand's looks end with the first that finds nothing, whatever strands lie beside it.
    wrong = isFirst ? wrong : both(wrong, wrong_);
    wrong_ = wrong;
    if (hn::AllFalse(D(), wrong)) return false;
    forEachNode([&](RodPoint& point, const RodNode& node, std::uint32_t p, RodMask lanes) {
        const V slack = rodSlackOf(point.contact, point.newDisplacement - point.displacement);
        const RodContact found =
            contactOf(root, node, p, point.near > hn::Zero(D()),
                      [&](const RodTouch& touch, RodMask) { return both(lanes, rodHolds(touch, slack)); });
        point.contact = rodChosen(wrong, found, point.contact);
    });
    // Other lanes take the same step again.
    objective_ = touched_ = hn::Zero(D());
    for (std::uint32_t j = first_; j < segments_; ++j) {
        RodPoint& point = points_[j];
        const std::size_t i = at(j);
        point.rotation = chosen(wrong, loadRotation(rod_.rotation, i), point.rotation);
        if constexpr (kBends) point.relative = chosen(wrong, point.newRelative, point.relative);
        point.displacement = select(wrong, point.newDisplacement, point.displacement);
        point.increment = select(wrong, load3(rod_.increment, i), point.increment);
        touched_ = hn::Max(touched_, point.contact.touching);
        const V3 off = point.displacement - point.target;
        objective_ = objective_ + point.contact.twiceEnergy + point.weight * dot(off, off);
        if constexpr (kBends) objective_ = objective_ + strainEnergy(point.relative, point.wanted, i);
    }
    objective_ = objective_ * all(0.5f);
    return true;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
