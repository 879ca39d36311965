// SPDX-License-Identifier: MIT
// A substep of elastic rods (docs/engine.md, "Rods"): a prediction, one elimination from tip to root, one
// pass back, and the guards that keep the objective from rising.
#if defined(HAIRLOOM_RUNTIME_ROD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_INL_H
#undef HAIRLOOM_RUNTIME_ROD_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_INL_H
#endif

#include <cmath>

#include "engine/lanes-inl.h"
#include "engine/wind-inl.h"
#include "hwy/highway.h"
#include "models/rods/rod_block.h"
#include "models/rods/rod_contact-inl.h"
#include "models/rods/rod_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// What a vector of strands keeps of segment j and of its outer node while it is solved; in
/// LaneFrame::solver.
struct RodPoint {
    V4 rotation;      ///< predicted
    V4 relative;      ///< predicted, of the vertex at the inner node
    V3 wanted;        ///< strain that elasticity and damping pull to together
    V3 increment;     ///< predicted rotation of this substep
    V3 displacement;  ///< predicted, of the outer node in this substep, world
    V3 target;        ///< where inertia, gravity and air alone would take it
    V weight;         ///< m/(h² D)
    RodGains gains;
    V3 newDisplacement;
    V4 newRelative;
    RodContact contact;
    V near;                ///< 1 where a shape is near the outer node, as predicted
    V3 tangent, position;  ///< predicted, of the segment and its outer node, relative to the root at the end
};

/// One vector of strands in one substep. Of a chain, which does not bend back, nothing of strains is read,
/// written or reckoned.
template <bool kBends, bool kTwists, bool kContacts>
class RodStrip {
  public:
    RodStrip(const RodBlock& block, LaneFrame& lanes, const SubstepContext& context, std::uint32_t lane)
        : block_(block),
          rod_(block.rod),
          lanes_(lanes),
          context_(context),
          numbers_(context.numbers.as<RodNumbers>()),
          lane_(lane),
          points_(reinterpret_cast<RodPoint*>(lanes.solver)),
          planes_(reinterpret_cast<BodyPlane*>(points_ + block.points)),
          first_(block.firstFree - 1),
          segments_(block.points - 1) {
        openStep();
    }

    void run() {
        kept_ = hn::Not(noLane());
        if constexpr (kContacts) {
            if (context_.body) {
                for (std::uint32_t j = first_; j < segments_; ++j) forgetPlane(planes_[j]);
            }
        }
        predict();
        const auto worse =
            objective_ > hn::MulAdd(startObjective_, all(static_cast<float>(HAIRLOOM_ROD_PREDICTION_SHARE)),
                                    rounding(startObjective_));
        if (!hn::AllFalse(D(), worse)) {
            kept_ = hn::Not(worse);
            predict();
        }
        descend();
        if constexpr (kContacts) {
            const int looks = context_.body ? HAIRLOOM_BODY_LOOKS : HAIRLOOM_ROD_CONTACT_LOOKS;
            for (int look = 0; look < looks && lookAgain(look); ++look) descend();
        }
        finish();
    }

  private:
    /// One step of Gauss-Newton from the guess.
    void descend() {
        eliminate();
        V share = all(1.0f);
        const V limit = objective_ + hn::MulAdd(objective_, all(1e-5f), rounding(objective_));
        for (int shortenings = 0;; ++shortenings) {
            const auto rose = hn::Not(advance(share) <= limit);
            if (shortenings > HAIRLOOM_ROD_SHORTENINGS || hn::AllFalse(D(), rose)) break;
            const V shorter = shortenings < HAIRLOOM_ROD_SHORTENINGS
                                  ? share * all(static_cast<float>(HAIRLOOM_ROD_SHORTENING))
                                  : hn::Zero(D());
            share = hn::IfThenElse(rose, shorter, share);
        }
    }

    std::size_t at(std::uint32_t j) const { return std::size_t{j} * kBlockLanes + lane_; }
    V4 loadRotation(const float* planes, std::size_t i) const {
        const float* const x = planes + i;
        return {hn::Load(D(), x), hn::Load(D(), x + block_.pitch), hn::Load(D(), x + 2 * block_.pitch),
                hn::Load(D(), x + 3 * block_.pitch)};
    }
    void storeRotation(V4 q, float* planes, std::size_t i) const {
        float* const x = planes + i;
        hn::Store(q.x, D(), x);
        hn::Store(q.y, D(), x + block_.pitch);
        hn::Store(q.z, D(), x + 2 * block_.pitch);
        hn::Store(q.w, D(), x + 3 * block_.pitch);
    }
    V lengthOf(std::uint32_t j) const { return hn::Load(D(), block_.length + at(j)); }

    /// The rounding error of an elastic energy: strains are wrong by about one unit in the last place.
    V rounding(V energy) const {
        return all(4.0f * static_cast<float>(HAIRLOOM_ROD_ROUNDING)) *
               hn::Sqrt(hn::Abs(energy + energy) * stiffnessSum_);
    }

    /// The time scheme: y = x + c (x − x₋), backward differences of second order with c = r²/(1 + 2r) for
    /// steps of the ratio r, backward Euler with c = 0.
    void openStep() {
        const V h = all(context_.h), ratio = all(context_.stepRatio);
        const float most = context_.stepRatio < static_cast<float>(HAIRLOOM_ROD_LONGEST_RATIO)
                               ? context_.stepRatio * context_.stepRatio / (1.0f + 2.0f * context_.stepRatio)
                               : 0.0f;
        const V turn = hn::Load(D(), rod_.turn + lane_);
        const V calm = hn::NegMulAdd(turn, all(static_cast<float>(HAIRLOOM_ROD_BLEND_SLOPE)),
                                     all(static_cast<float>(HAIRLOOM_ROD_BLEND_END)));
        blend_ = all(most) * hn::Min(hn::Max(calm, hn::Zero(D())), all(1.0f));
        velocityAhead_ = blend_ * all(1.0f / context_.stepRatio + 2.0f);
        step_ = h * (all(1.0f) - blend_ / ratio);
        inverseStep_ = all(1.0f) / step_;
        damped_ = rodDamped(numbers_, inverseStep_);
        dampingShare_ = (damped_ - all(1.0f)) / damped_;
        rootDisplacement_ = load3(lanes_.rootDisplacement, lane_);
        takeRoot();
        if (rod_.poseRate) rotationBefore_ = rotationAt(context_.index);
    }

    /// Of the root, when so many substeps of the frame are through: as the stage `roots` has it.
    V4 rotationAt(std::uint32_t substep) const {
        const V4 from = load4(lanes_.rotationFrom, lane_), to = load4(lanes_.rotationTo, lane_);
        const V t = all(static_cast<float>(substep) / static_cast<float>(context_.count));
        const V4 mixed{lerp(from.x, to.x, t), lerp(from.y, to.y, t), lerp(from.z, to.z, t),
                       lerp(from.w, to.w, t)};
        const V inverse = all(1.0f) / hn::Sqrt(mixed.x * mixed.x + mixed.y * mixed.y + mixed.z * mixed.z +
                                               mixed.w * mixed.w);
        return {mixed.x * inverse, mixed.y * inverse, mixed.z * inverse, mixed.w * inverse};
    }

    /// Turns the clamped segment with its root, or, where only the root is held, the frame that stands for
    /// one.
    void takeRoot() {
        const V4 root = load4(lanes_.rotation, lane_);
        inner_ = root;
        inDisplacement_ = rootDisplacement_;
        if (block_.firstFree > 1) {
            const V4 before = loadRotation(rod_.rotation, at(0));
            const V3 along = restTangent(0);
            inDisplacement_ =
                mad3(rodRotate(inner_, along) - rodRotate(before, along), lengthOf(0), rootDisplacement_);
            storeRotation(inner_, rod_.rotation, at(0));
        }
        const V4 from = load4(lanes_.rotationFrom, lane_), to = load4(lanes_.rotationTo, lane_);
        const V turned =
            hn::Abs(from.x - to.x) + hn::Abs(from.y - to.y) + hn::Abs(from.z - to.z) + hn::Abs(from.w - to.w);
        const V moved = dot(rootDisplacement_, rootDisplacement_) + turned;
        still_ = hn::And(moved <= hn::Zero(D()), all(context_.conservative ? 1.0f : 0.0f) > hn::Zero(D()));
    }

    /// A predicted rotation, which is no longer than HAIRLOOM_ROD_LARGEST_PREDICTION.
    static V3 shortened(V3 u) {
        const V squared = dot(u, u);
        const V most = all(static_cast<float>(HAIRLOOM_ROD_LARGEST_PREDICTION));
        const auto longer = squared > most * most;
        if (HWY_LIKELY(hn::AllFalse(D(), longer))) return u;
        return u * hn::IfThenElse(longer, most / hn::Sqrt(squared), all(1.0f));
    }

    /// Repeats the last substep's rotations, in lanes that keep them.
    void placePrediction() {
        V3 outer = inDisplacement_;
        V3 position = zero3();  // of the inner node, relative to the root at the end of the substep
        if (block_.firstFree > 1) position = rodRotate(inner_, restTangent(0)) * lengthOf(0);
        for (std::uint32_t j = first_; j < segments_; ++j) {
            RodPoint& point = points_[j];
            const std::size_t i = at(j);
            const V4 old = loadRotation(rod_.rotation, i);
            const V3 along = restTangent(j);
            V3 u = load3(rod_.increment, i) * all(context_.stepRatio);
            u = onlyWhere(kept_, shortened(u));
            const V length = lengthOf(j);
            outer = mad3(rodTangentChange(u, rodRotate(old, along)), length, outer);
            point.increment = u;
            point.rotation = rodTurned(old, u);
            point.displacement = outer;
            point.tangent = rodRotate(point.rotation, along);
            position = mad3(point.tangent, length, position);
            point.position = position;
        }
    }

    /// Finds the objective of the prediction and where nothing turns, and what it meets.
    void predict() {
        placePrediction();
        if constexpr (kContacts) {
            if (context_.body) searchPrediction();
        }
        V4 before = inner_;
        objective_ = startObjective_ = stiffnessSum_ = touched_ = hn::Zero(D());
        near_ = noLane();
        for (std::uint32_t j = first_; j < segments_; ++j) {
            RodPoint& point = points_[j];
            const std::size_t i = at(j);
            aim(point, at(j + 1), point.tangent, point.position);
            if constexpr (kContacts) meet(point, point.tangent, point.position, j + 1);

            const V3 off = point.displacement - point.target, offStart = inDisplacement_ - point.target;
            if constexpr (kBends) {
                const V3 strain = load3(rod_.strain, i), wanted = blendStrain(strain, i);
                const V4 last = rodOfStrain(strain);
                point.wanted = wanted;
                point.relative = rodRelative(before, point.rotation, last);
                const V bend = dampedBend(i);
                const RodSection section = sectionOf(i, bend);
                stiffnessSum_ = stiffnessSum_ + bend;
                objective_ = objective_ + rodTwiceEnergy(twice(point.relative) - wanted, bend, section);
                V3 strainStart = strain;
                if (j == first_)
                    strainStart = twice(rodRelative(inner_, loadRotation(rod_.rotation, i), last));
                startObjective_ = startObjective_ + rodTwiceEnergy(strainStart - wanted, bend, section);
            }
            objective_ = objective_ + point.weight * dot(off, off);
            startObjective_ = startObjective_ + point.weight * dot(offStart, offStart);
            if constexpr (kContacts) {
                objective_ = objective_ + point.contact.twiceEnergy;
                startObjective_ = startObjective_ +
                                  rodContactTwiceEnergy(point.contact, inDisplacement_ - point.displacement);
            }
            before = point.rotation;
        }
        objective_ = objective_ * all(0.5f);
        startObjective_ = startObjective_ * all(0.5f);
    }

    static V3 twice(V4 relative) {
        return {relative.x + relative.x, relative.y + relative.y, relative.z + relative.z};
    }
    /// Twice that of a vertex, with its damping.
    V strainEnergy(V4 relative, V3 wanted, std::size_t i) const {
        const V bend = dampedBend(i);
        return rodTwiceEnergy(twice(relative) - wanted, bend, sectionOf(i, bend));
    }
    /// B/l̄ of a vertex, with its damping.
    V dampedBend(std::size_t i) const { return hn::Load(D(), rod_.bend + i) * damped_; }
    V3 restTangent(std::uint32_t j) const { return load3(rod_.tangent, at(j)); }
    /// Of a vertex, for its B/l̄.
    RodSection sectionOf(std::size_t i, V bend) const {
        RodSection section{zero3(), zero3(), hn::Zero(D()), hn::Zero(D()), kTwists, false};
        if constexpr (kTwists) {
            section.axis = load3(rod_.axis, i);
            section.twist = bend * all(numbers_.twist);
            section.isFlat = numbers_.flat != 0.0f;
            if (section.isFlat) {
                section.normal = load3(rod_.normal, i);
                section.flat = bend * all(numbers_.flat);
            }
        }
        return section;
    }

    /// Damping pulls to the strain extrapolated from the last two substeps (Kelvin-Voigt), elasticity to that
    /// of a pose, and to none without.
    V3 blendStrain(V3 strain, std::size_t i) const {
        const V3 extrapolated = mad3(strain - load3(rod_.strainBefore, i), blend_, strain);
        V3 wanted = extrapolated * dampingShare_;
        if (rod_.poseRate) wanted = wanted + load3(rod_.poseStrain, i) * (all(1.0f) - dampingShare_);
        return wanted;
    }

    /// Where inertia, gravity and air take a node, which the prediction has at `position`.
    void aim(RodPoint& point, std::size_t node, V3 tangent, V3 position) const {
        const V3 now = load3(rod_.velocity, node), faster = now - load3(rod_.velocityBefore, node);
        const V3 velocity = mad3(faster, blend_, now);
        V3 change = mad3(all3(context_.gravity), step_, velocity);
        V rate = all(numbers_.rootDamping);
        change = mad3(rootDisplacement_, all(numbers_.rootDamping / context_.h) * step_, change);
        if (context_.air != Air::none) {
            V3 air = zero3();
            if (context_.air == Air::moving)
                air = shelteredWindAt(*context_.wind, context_.windPhases, position + rootPosition(),
                                      context_, static_cast<float>(context_.index + 1));
            // Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz
            // 2012, Section 3.3); velocity and tangent are predicted for the end of the substep, so that the
            // scheme keeps its order.
            const V3 flow = air - mad3(faster, velocityAhead_, now);
            const V all2 = dot(flow, flow), parallel = dot(flow, tangent);
            const V sine = hn::Sqrt(hn::Max(negMad(parallel, parallel, all2), hn::Zero(D())) /
                                    hn::Max(all2, all(1e-30f)));
            const V drag = sine * all(context_.airDrag);
            rate = rate + drag;
            change = mad3(air, drag * step_, change);
        }
        if (block_.hairRate) {
            rate = rate + hn::Load(D(), block_.hairRate + node);
            change = mad3(load3(block_.hairPush, node), step_, change);
        }
        V3 pose = zero3();  // relative to the root at the end
        if (rod_.poseRate) {
            // Moves as the pose does with the root, but for what brings it there.
            const V3 rest = load3(rod_.pose, node);
            pose = rodRotate(inner_, rest);
            const V3 along = pose - rodRotate(rotationBefore_, rest) + rootDisplacement_;
            const V slow = poseRateOf(node) * all(2.0f);
            rate = rate + slow;
            change = mad3(along, slow * all(1.0f / context_.h) * step_, change);
        }
        const V slowed = mad(rate, step_, all(1.0f));
        point.target = mad3(load3(rod_.displacement, node), blend_, change * (step_ / slowed));
        point.weight = hn::Load(D(), rod_.mass + node) * inverseStep_ * inverseStep_ * slowed;
        if (rod_.poseRate) {
            const V3 way = pose - position;
            const V pull = rodPosePull(hn::Load(D(), rod_.mass + node), poseRateOf(node), way);
            const V both = point.weight + pull;
            point.target = mad3(point.displacement + way - point.target, pull / both, point.target);
            point.weight = both;
        }
    }
    /// How fast node `node` comes to its pose, 1/s.
    V poseRateOf(std::size_t node) const { return hn::Load(D(), rod_.poseRate + node); }
    V3 rootPosition() const {
        return mad3(rootDisplacement_, all(static_cast<float>(context_.index + 1)),
                    load3(lanes_.root, lane_));
    }

    RodNode nodeOf(const RodPoint& point, V3 displacement, V3 tangent, V3 position, std::uint32_t p) const {
        const std::size_t node = at(p);
        const V3 velocity = load3(rod_.velocity, node);
        const V stiffness = hn::Load(D(), rod_.mass + node) *
                            all(static_cast<float>(HAIRLOOM_ROD_CONTACT) / (context_.h * context_.h));
        return {position,
                displacement,
                tangent,
                velocity,
                velocity - load3(rod_.velocityBefore, node),
                point.weight,
                stiffness,
                hn::Load(D(), rod_.load + node),
                step_,
                all(radiusOf(p)),
                all(context_.body || context_.restitution > 0.0f ? 0.0f : 1.0f)};
    }
    /// Metres that node p keeps from shapes.
    float radiusOf(std::uint32_t p) const {
        const float along = static_cast<float>(p) / static_cast<float>(segments_);
        return context_.collisionRadiusAtRoot +
               along * (context_.collisionRadiusAtTip - context_.collisionRadiusAtRoot);
    }
    void press(const RodTouch& touch, RodMask held, const RodNode& node, V friction,
               RodContact& contact) const {
        if (hn::AllFalse(D(), held)) return;
        rodPress(touch, held, node, all(1.0f / context_.h), friction, all(context_.restitution), contact);
    }
    void meet(RodPoint& point, V3 tangent, V3 position, std::uint32_t p) {
        const RodNode node = nodeOf(point, point.displacement, tangent, position, p);
        auto near = noLane();
        point.contact =
            contactOf(rootPosition(), node, p, hn::Not(noLane()), [&](const RodTouch& touch, RodMask here) {
                near = either(near, here);
                return rodHolds(touch,
                                context_.body ? bodySlackAfter(touch, node) : rodSlackAfter(node.load));
            });
        touched_ = hn::Max(touched_, point.contact.touching);
        near_ = either(near_, near);
        point.near = hn::IfThenElseZero(near, all(1.0f));
    }

    /// As forEachTouch(), of spheres for lanes that are `near` some, and of the body; `p`: the node's number.
    template <class Visit>
    void forEachShape(V3 root, const RodNode& node, std::uint32_t p, RodMask near, Visit&& visit) {
        if (!hn::AllFalse(D(), near)) forEachTouch(lanes_, root, node, context_, visit);
        if (context_.body) touchBody(node, block_, at(p), planes_[p - 1], visit);
    }

    // models/rods/rod_look-inl.h
    BodySearch bodySearch() const { return {context_, block_, lane_, planes_}; }
    void searchPrediction();
    void searchStep();
    RodMask mayTouch(std::uint32_t j) const;
    bool anyMayTouch() const;
    template <class Holds>
    RodContact contactOf(V3 root, const RodNode& node, std::uint32_t p, RodMask near, const Holds& holds);
    template <class Holds>
    RodContact pressedBy(V3 root, const RodNode& node, std::uint32_t p, RodMask near, V friction,
                         const Holds& holds);
    template <class Holds>
    RodContact pressedBySeveral(V3 root, const RodNode& node, std::uint32_t p, RodMask near, V least,
                                const Holds& holds);
    template <class Visit>
    void forEachNode(Visit&& visit);
    bool lookAgain(int look);
    static V4 chosen(RodMask which, V4 yes, V4 no) {
        return {choose(which, yes.x, no.x), choose(which, yes.y, no.y), choose(which, yes.z, no.z),
                choose(which, yes.w, no.w)};
    }

    void eliminate() {
        RodForm form = noForm();
        for (std::uint32_t j = segments_; j-- > first_;) {
            RodPoint& point = points_[j];
            V3 r = (point.displacement - point.target) * point.weight;
            if constexpr (kContacts) {
                r = r + point.contact.gradient;
                const V* const h = point.contact.hessian;
                rodAddContact(form, h[0], h[1], h[2], h[3], h[4], h[5]);
            }
            rodAddNode(form, point.weight, r, onlyWhere(kept_, r));
            const V3 tangent = rodRotate(point.rotation, restTangent(j));
            if constexpr (kBends) {
                const V bend = dampedBend(at(j));
                rodEliminate(form, point.rotation, tangent, lengthOf(j), point.relative,
                             twice(point.relative) - point.wanted, bend, sectionOf(at(j), bend), point.gains);
            } else {
                const V zero = hn::Zero(D());
                rodEliminate(form, point.rotation, tangent, lengthOf(j), V4{zero, zero, zero, all(1.0f)},
                             zero3(), zero, RodSection{zero3(), zero3(), zero, zero, false, false},
                             point.gains);
            }
        }
    }

    /// Turns the segments from root to tip; returns the objective.
    V advance(V share) {
        V3 outer = inDisplacement_, x = zero3(), u = zero3();
        V3 predicted = inDisplacement_;
        V4 before = inner_;
        V sum = hn::Zero(D());
        for (std::uint32_t j = first_; j < segments_; ++j) {
            RodPoint& point = points_[j];
            const std::size_t i = at(j);
            u = u - V3{rodGain(point.gains, 0, share, x, u), rodGain(point.gains, 1, share, x, u),
                       rodGain(point.gains, 2, share, x, u)};
            const V4 q = rodTurned(point.rotation, u);
            const V3 change = rodTangentChange(u, rodRotate(point.rotation, restTangent(j)));
            // Displacements are summed from rotations: differences of positions would lose their digits.
            outer = mad3(change, lengthOf(j), outer) + (point.displacement - predicted);
            predicted = point.displacement;
            x = outer - predicted;
            const V3 off = outer - point.target;
            if constexpr (kBends) {
                point.newRelative = rodRelative(before, q, point.relative);
                sum = sum + strainEnergy(point.newRelative, point.wanted, i);
            }
            sum = sum + point.weight * dot(off, off);
            if constexpr (kContacts) sum = sum + rodContactTwiceEnergy(point.contact, x);
            point.newDisplacement = outer;
            storeRotation(q, rod_.rotation, i);
            store3(point.increment + u, rod_.increment, i);
            before = q;
        }
        return sum * all(0.5f);
    }

    void finish();  // models/rods/rod_finish-inl.h
    void keepFolds(std::uint32_t j, V3 moved, RodMask pressed, RodMask was);
    void slow(V share);

    const RodBlock& block_;
    const RodView& rod_;
    LaneFrame& lanes_;
    const SubstepContext& context_;
    RodNumbers numbers_;
    std::uint32_t lane_;
    RodPoint* points_;
    BodyPlane* planes_;  ///< of outer nodes
    std::uint32_t first_, segments_;
    V blend_, step_, inverseStep_;
    V velocityAhead_;          ///< share of the last change of velocity that is expected again
    V damped_, dampingShare_;  ///< 1 + τ/h, and the part of it that is damping
    V3 rootDisplacement_, inDisplacement_;
    V4 inner_;           ///< rotation of the segment before the first free one
    V4 rotationBefore_;  ///< of the root, at the start of the substep; where there are poses
    hn::Mask<D> kept_, still_;
    V objective_, startObjective_, stiffnessSum_;
    V touched_;         ///< most of RodContact::touching
    hn::Mask<D> near_;  ///< a shape is near some node
    RodMask wrong_;     ///< the last look has found something
};

template <bool kBends, bool kTwists, bool kContacts>
void stepRodsWith(const RodBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth)
        RodStrip<kBends, kTwists, kContacts>(block, lanes, context, lane).run();
}

template <bool kContacts>
void stepRodsIn(const RodBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    if (!block.rod.bend) return stepRodsWith<false, false, kContacts>(block, lanes, context);
    block.rod.curved ? stepRodsWith<true, true, kContacts>(block, lanes, context)
                     : stepRodsWith<true, false, kContacts>(block, lanes, context);
}

/// Each block pays for what its strands need.
void stepRods(const BlockView& view, LaneFrame& lanes, const SubstepContext& context) {
    const auto& block = static_cast<const RodBlock&>(view);
    const bool contacts = !lanes.touchable.empty() || !lanes.touchableCapsules.empty() || context.body;
    contacts ? stepRodsIn<true>(block, lanes, context) : stepRodsIn<false>(block, lanes, context);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
