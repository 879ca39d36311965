// SPDX-License-Identifier: MIT
// The end of a substep of rods: what it leaves, and the guard of its energy.
#if defined(HAIRLOOM_RUNTIME_ROD_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_FINISH_INL_H
#undef HAIRLOOM_RUNTIME_ROD_FINISH_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_FINISH_INL_H
#endif

#include <cmath>

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/rods/rod-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Takes the step: places, velocities, and what the next one starts from.
template <bool kBends, bool kTwists, bool kContacts>
void RodStrip<kBends, kTwists, kContacts>::finish() {
    V3 position = zero3();
    if (block_.firstFree > 1) position = rodRotate(inner_, restTangent(0)) * lengthOf(0);
    V turn = hn::Zero(D()), energy = hn::Zero(D()), kinetic = hn::Zero(D()), size = hn::Zero(D()),
      masses = hn::Zero(D());
    V stiffness = hn::Zero(D());
    V work = hn::Zero(D()), worked = hn::Zero(D());  // by the hair around, and its size
    // The least that the normal part of a contact's force can be of it.
    const V normalShare = all(1.0f / std::sqrt(1.0f + context_.friction * context_.friction));
    // A bounce is no smooth motion: speeds behind it are those of the mean way.
    const auto bounces = touched_ > all(2.0f);
    const V blend = hn::IfThenZeroElse(bounces, blend_);
    const V inverseStep = hn::IfThenElse(bounces, all(1.0f / context_.h), inverseStep_);
    // What goes back and forth on skin is as fast as it gets on.
    const auto settles = context_.body && context_.restitution <= 0.0f ? touched_ > hn::Zero(D()) : noLane();
    for (std::uint32_t j = first_; j < segments_; ++j) {
        const RodPoint& point = points_[j];
        const std::size_t i = at(j), node = at(j + 1);
        position = mad3(rodRotate(loadRotation(rod_.rotation, i), restTangent(j)), lengthOf(j), position);
        const V3 moved = point.newDisplacement;
        const V3 before = load3(rod_.displacement, node);
        V3 velocity = negMad3(before, blend, moved) * inverseStep;
        if constexpr (kContacts) {
            const auto mean = both(settles, goesBack(moved, before, context_.h));
            velocity = select(mean, (moved + before) * all(0.5f / context_.h), velocity);
        }
        store3(load3(rod_.velocity, node), rod_.velocityBefore, node);
        store3(velocity, rod_.velocity, node);
        store3(moved, rod_.displacement, node);
        store3(position, block_.position, node);
        store3(position - moved, block_.previous, node);
        const V3 increment = load3(rod_.increment, i);
        turn = hn::Max(turn, dot(increment, increment));
        const V mass = hn::Load(D(), rod_.mass + node);
        V elastic = hn::Zero(D());
        if constexpr (kBends) {
            // Strains are those of quaternions with w ≥ 0; the one before goes with the new one.
            const V3 strain = withSignOf(twice(point.newRelative), point.newRelative.w);
            store3(withSignOf(load3(rod_.strain, i), point.newRelative.w), rod_.strainBefore, i);
            store3(strain, rod_.strain, i);
            const V bend = hn::Load(D(), rod_.bend + i);
            stiffness = stiffness + bend;
            const V3 off = rod_.poseRate ? strain - load3(rod_.poseStrain, i) : strain;
            elastic = rodTwiceEnergy(off, bend, sectionOf(i, bend)) * all(0.5f);
        }
        if (rod_.poseRate) {
            const V3 way = rodRotate(inner_, load3(rod_.pose, node)) - position;
            elastic = mad(rodPoseTwiceEnergy(mass, poseRateOf(node), way), all(0.5f), elastic);
        }
        const V weight = mass * dot(all3(context_.gravity), position);
        energy = energy + (elastic - weight);
        size = size + (elastic + hn::Abs(weight));
        kinetic = mad(mass * all(0.5f), dot(velocity, velocity), kinetic);
        masses = masses + mass;
        if (block_.hairRate) {
            const V3 push =
                negMad3(velocity, hn::Load(D(), block_.hairRate + node), load3(block_.hairPush, node));
            const V done = mass * dot(push, moved);
            work = work + done;
            worked = worked + hn::Abs(done);
        }
        if constexpr (kContacts) {
            const V3 force = rodContactForce(point.contact, moved - point.displacement);
            V load = hn::Sqrt(dot(force, force)) * normalShare;
            load = hn::IfThenElse(point.contact.touching > all(1.0f), hn::Neg(load), load);
            load = hn::IfThenElseZero(dot(force, point.contact.normal) > hn::Zero(D()), load);
            if (context_.body) {
                const V last = hn::Load(D(), rod_.load + node);
                keepFolds(j, moved, load != hn::Zero(D()), last != hn::Zero(D()));
            }
            hn::Store(load, D(), rod_.load + node);
        } else if (rod_.load) {
            hn::Store(hn::Zero(D()), D(), rod_.load + node);
        }
    }
    turn = hn::IfThenElse(bounces, all(kRodNoStep), hn::Sqrt(turn));
    // While nothing moves the root and no air blows, energy rises by no more than the hair around does in
    // work: what rounding and the time scheme add is taken back.
    const V last = hn::Load(D(), rod_.energy + lane_) + work;
    V noise = all(30.0f * static_cast<float>(HAIRLOOM_ROD_ROUNDING)) * (size + kinetic + worked) +
              all(4.0f * static_cast<float>(HAIRLOOM_ROD_ROUNDING)) * hn::Sqrt((size + size) * stiffness);
    // Where spheres press, what is as slow as this is rounding.
    constexpr float kSlow = static_cast<float>(HAIRLOOM_ROD_CONTACT_SPEED);
    if constexpr (kContacts)
        noise =
            hn::IfThenElse(touched_ > hn::Zero(D()), mad(masses, all(0.5f * kSlow * kSlow), noise), noise);
    const auto rose = hn::And(still_, hn::And(energy + kinetic > last + noise, kinetic > hn::Zero(D())));
    V after = energy + kinetic;
    if (!hn::AllFalse(D(), rose)) {
        const V share = hn::IfThenElse(
            rose,
            hn::Sqrt(
                hn::Min(hn::Max((last - energy) / hn::Max(kinetic, all(1e-30f)), hn::Zero(D())), all(1.0f))),
            all(1.0f));
        slow(share);
        after = mad(kinetic, share * share, energy);
        const auto guarded = share < all(0.9f);
        turn = hn::IfThenElse(guarded, all(kRodNoStep), turn);
        lanes_.guarded |= bitsOf(guarded) << lane_;
    }
    // What contacts with spheres that move do is work that is not counted here. Those that rest can only
    // take: what they push out comes to rest outside.
    if constexpr (kContacts) {
        if (!context_.spheresRest) after = hn::IfThenElse(touched_ > hn::Zero(D()), all(kRodNoEnergy), after);
    }
    hn::Store(after, D(), rod_.energy + lane_);
    hn::Store(turn, D(), rod_.turn + lane_);
}

/// Keeps the planes that `pressed` the outer node of segment j, for the next substep, in place of those of
/// what `was` pressed.
template <bool kBends, bool kTwists, bool kContacts>
void RodStrip<kBends, kTwists, kContacts>::keepFolds(std::uint32_t j, V3 moved, RodMask pressed,
                                                     RodMask was) {
    if (HWY_LIKELY(hn::AllFalse(D(), either(pressed, was)))) return;
    const BodyPlane& plane = planes_[j];
    const std::size_t i = at(j + 1), pitch = block_.pitch;
    float* const fold = rod_.fold + i;
    // A sphere may have pressed it, beside skin that did not.
    const V reach = bodyReach(all(radiusOf(j + 1)), block_, i) + all(kFoldReach);
    const V own = plane.level + dot(plane.normal, moved),
            other = plane.otherLevel + dot(plane.otherNormal, moved);
    const auto found = both(pressed, plane.known > hn::Zero(D()));
    const auto known = both(found, own < reach), folds = both(found, other < reach);
    const auto store = [&](RodMask which, V3 normal, V away, float* to) {
        hn::Store(hn::IfThenElseZero(which, normal.x), D(), to);
        hn::Store(hn::IfThenElseZero(which, normal.y), D(), to + pitch);
        hn::Store(hn::IfThenElseZero(which, normal.z), D(), to + 2 * pitch);
        hn::Store(hn::IfThenElseZero(which, away), D(), to + 3 * pitch);
    };
    store(known, plane.normal, own, fold);
    store(folds, plane.otherNormal, other, fold + 4 * pitch);
}

template <bool kBends, bool kTwists, bool kContacts>
void RodStrip<kBends, kTwists, kContacts>::slow(V share) {
    for (std::uint32_t j = first_; j < segments_; ++j) {
        store3(load3(rod_.velocity, at(j + 1)) * share, rod_.velocity, at(j + 1));
        store3(load3(rod_.increment, at(j)) * share, rod_.increment, at(j));
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
