// SPDX-License-Identifier: MIT
// How nodes of rods find the plane that stands for a body (docs/engine.md, "Bodies").
#if defined(HAIRLOOM_RUNTIME_ROD_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_SEARCH_INL_H
#undef HAIRLOOM_RUNTIME_ROD_SEARCH_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_SEARCH_INL_H
#endif

#include <bit>

#include "engine/body_free.h"
#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "engine/moving_body.h"
#include "hwy/highway.h"
#include "models/rods/rod_block.h"
#include "models/rods/rod_body-inl.h"
#include "models/rods/rod_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// The plane that stands for a body in a substep, for a node of each lane, and where it was looked at.
struct BodyPlane {
    // What a search finds.
    V3 normal;
    V distance;  ///< metres, at `at`
    V before;
    V3 way;
    V known;  ///< 1 where it is of this substep
    V room;   ///< metres that the node may go and touch nothing, beyond the displacement
    V meets;  ///< 1 where it holds for the guess that was searched last
    V level;  ///< metres from it of a node that would not move in the substep; any where it is not known
    // What it was told.
    V3 at;     ///< the node, relative to its root
    V3 moved;  ///< displacement that it had when it was last seen in this substep
    // What a look before found, in this substep or the last one, where skin folds: both press there. Any
    // where the plane is not known.
    V3 otherNormal;  ///< 0 where there is none
    V otherLevel;    ///< as `level`
};
/// Numbers of each lane that a search finds, of the plane before, and of its normal.
constexpr std::size_t kBodyFound = 12, kBodyOther = 18;
static_assert(sizeof(BodyPlane) == (kBodyOther + 4) * sizeof(V));

/// Nothing is known of it yet.
HWY_INLINE void forgetPlane(BodyPlane& plane) {
    plane.at = plane.normal = plane.way = plane.moved = zero3();
    plane.distance = plane.before = plane.known = plane.room = plane.meets = hn::Zero(D());
}

/// How nodes of a body's skin are seen: bodySeen of a node of each lane.
struct BodySeen {
    V3 place;  ///< in the space of the carrier
    V carried, other, number;
};
HWY_INLINE BodySeen bodySeenAt(const float* at, std::size_t pitch) {
    return {load3(at, pitch), hn::Load(D(), at + 3 * pitch), hn::Load(D(), at + 4 * pitch),
            hn::Load(D(), at + 5 * pitch)};
}

/// What is asked of a node of each lane.
struct BodyNode {
    V3 position_ws, displacement;
    V reach;  ///< metres that it keeps from the body
    BodySeen seen;
};

/// Metres that a node keeps from a body: its radius, but no more than its clearance.
HWY_INLINE V bodyReach(V radius, const BlockView& block, std::size_t i) {
    return hn::Min(radius, hn::Load(D(), block.clearance + i));
}
/// Metres within which a node counts as near.
HWY_INLINE V bodyMargin(V reach) {
    return reach + all(static_cast<float>(HAIRLOOM_ROD_CONTACT_NEAR));
}

/// How a node has gone since it was looked at, and what of its free way is left.
struct BodyLeft {
    V3 place;          ///< in the space of the carrier
    V carried, other;  ///< metres to skin of the carrier and to other skin
};
HWY_INLINE BodyLeft leftOf(const LaneCarrier& carrier, const BodyNode& node) {
    BodyLeft left;
    left.place = carrier.inverse.apply(node.position_ws);
    // On its way through the substep no node is farther from where it was looked at than at one of its ends.
    const V3 start_ws = node.position_ws - node.displacement;
    const V3 since = left.place - node.seen.place,
             sinceStart = carrier.inverseBefore.apply(start_ws) - node.seen.place;
    const V used = hn::Sqrt(hn::Max(dot(since, since), dot(sinceStart, sinceStart))) * carrier.largest;
    left.carried = node.seen.carried - used;
    left.other = node.seen.other - (used + carrier.strayed);
    return left;
}

/// Finds the planes of `searched` lanes. Where all that is near hangs on one bone, it is looked up at rest;
/// what else there is, lookOfLanes() finds. No lane hangs on another.
HWY_NOINLINE void searchBody(const MovingBody& body, std::uint32_t substep, RodMask searched, BodyNode& node,
                             BodyPlane& plane) {
    constexpr auto kDeep = static_cast<float>(HAIRLOOM_ROD_CONTACT_DEEP);
    const V3 position_ws = node.position_ws;
    const V reach = node.reach, margin = bodyMargin(reach);
    LaneCarrier carrier = carrierOfLanes(body.carriers(substep), node.seen.number);
    auto [place, carried, other] = leftOf(carrier, node);
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
    // They are known from where they are now.
    node.seen = {place, carried, other + carrier.strayed, carrier.number};
    plane.known = plane.meets = hn::IfThenElseZero(met, all(1.0f));
    plane.level = plane.distance - dot(plane.normal, node.displacement);
    plane.room = (hn::Min(carried, other) - reach) * carrier.least;
}

/// Looks for the planes of a strip's nodes. Few lanes of a vector need a look at once: nodes that do are
/// gathered from all of the strip, and searched in full vectors.
class BodySearch {
  public:
    /// `planes`: of the outer node of each segment; `lane`: the strip's first.
    BodySearch(const SubstepContext& context, const RodBlock& block, std::uint32_t lane, BodyPlane* planes)
        : body_(*context.body),
          block_(block),
          substep_(context.index),
          slow_(static_cast<float>(HAIRLOOM_ROD_CONTACT_SLOW) * context.h),
          lane_(lane),
          planes_(planes) {
        std::memset(asked_, 0, sizeof(asked_));
    }

    /// Nodes that were far off when they were last looked at, and have not come far since, are not looked at.
    /// In a substep the plane that was found holds for all guesses that are close to where it was found, and
    /// for those that are outside for certain. `p`: the node's number; only of `lanes`.
    void add(V3 root, V3 position, V3 displacement, V radius, std::uint32_t p, RodMask lanes) {
        BodyPlane& plane = planes_[p - 1];
        const std::size_t i = std::size_t{p} * kBlockLanes + lane_;
        const V reach = bodyReach(radius, block_, i);
        const auto kept = keeps(plane, position, reach);
        plane.meets = hn::IfThenElseZero(kept, all(1.0f));
        if (hn::AllTrue(D(), either(kept, hn::Not(lanes)))) return;
        const BodyNode node{position + root, displacement, reach,
                            bodySeenAt(block_.bodySeen + i, block_.pitch)};
        const LaneCarrier carrier = carrierOfLanes(body_.carriers(substep_), node.seen.number);
        const BodyLeft left = leftOf(carrier, node);
        const V margin = bodyMargin(reach);
        const auto far = both(both(left.carried > margin, left.other > margin), carrier.usable);
        plane.room = (hn::Min(left.carried, left.other) - reach) * carrier.least;
        plane.moved = displacement;
        const auto searched = both(lanes, hn::Not(either(kept, far)));
        if (HWY_LIKELY(hn::AllFalse(D(), searched))) return;
        plane.at = select(searched, position, plane.at);
        gather(node, p, bitsOf(searched));
    }

    /// Of all that were added.
    void finish() {
        if (count_ > 0) search();
    }

  private:
    static constexpr std::size_t kAsked = sizeof(BodyNode) / sizeof(V), kSeen = sizeof(BodySeen) / sizeof(V);
    static_assert(kSeen == kBodyPlanes);

    /// Lanes whose plane holds.
    static RodMask keeps(const BodyPlane& plane, V3 position, V reach) {
        const auto known = plane.known > hn::Zero(D());
        if (hn::AllFalse(D(), known)) return known;
        constexpr float kClose = 1e-4f, kClearly = 1e-4f;  // metres
        const V3 from = position - plane.at;
        const V gone = hn::Sqrt(dot(from, from));
        const auto outside = negMad(gone, all(1.25f), plane.distance) > reach + all(kClearly);
        return both(known, either(gone <= all(kClose), outside));
    }

    void gather(const BodyNode& node, std::uint32_t p, std::uint32_t bits) {
        alignas(64) float numbers[kAsked][kWidth];
        static_assert(sizeof(numbers) == sizeof(node));
        std::memcpy(numbers, &node, sizeof(node));
        for (; bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
            for (std::size_t k = 0; k < kAsked; ++k) asked_[k][count_] = numbers[k][lane];
            points_[count_] = p;
            lanes_[count_] = lane;
            if (++count_ == kWidth) search();
        }
    }

    void search() {
        BodyNode node;
        std::memcpy(&node, asked_, sizeof(node));
        BodyPlane plane;
        forgetPlane(plane);
        searchBody(body_, substep_, hn::FirstN(D(), count_), node, plane);
        alignas(64) float found[kBodyFound][kWidth], seen[kSeen][kWidth];
        std::memcpy(found, &plane, sizeof(found));
        std::memcpy(seen, &node.seen, sizeof(seen));
        for (std::size_t n = 0; n < count_; ++n) {
            const std::size_t i = std::size_t{points_[n]} * kBlockLanes + lane_ + lanes_[n];
            float* const to = reinterpret_cast<float*>(planes_ + points_[n] - 1) + lanes_[n];
            float numbers[kBodyFound];
            for (std::size_t k = 0; k < kBodyFound; ++k) numbers[k] = found[k][n];
            if (numbers[kMeets] > 0.0f) {
                const Float3 moved{asked_[3][n], asked_[4][n], asked_[5][n]};
                keepOther(numbers, moved, asked_[6][n], i, to);
            }
            for (std::size_t k = 0; k < kBodyFound; ++k) to[k * kWidth] = numbers[k];
            float* const known = block_.bodySeen + i;
            for (std::size_t k = 0; k < kSeen; ++k) known[k * block_.pitch] = seen[k][n];
        }
        count_ = 0;
    }

    /// Keeps beside a plane that a look has found, for a node that has `moved`, another one that pressed it
    /// in the look before or in the last substep, where the node is slow: then the skin folds there. `i`: of
    /// the node; `plane`: of the look before. Planes that did not press may not have been looked for.
    void keepOther(const float* found, Float3 moved, float reach, std::size_t i, float* plane) const {
        const Float3 normal{found[0], found[1], found[2]}, way{found[kWay], found[kWay + 1], found[kWay + 2]};
        const std::size_t pitch = block_.pitch;
        float* const other = plane + kBodyOther * kWidth;
        const auto isOther = [&](const float* at, std::size_t step, float level) {
            const Float3 n{at[0], at[step], at[2 * step]};
            const float along = dot(normal, n);
            // In a gap that is narrower than the node is wide both sides push it, towards each other.
            const bool between = found[kDistance] > 0.0f && level + dot(n, moved) > 0.0f;
            return (along > kFoldsBack || between) && along < kFoldsAhead && dot(n, n) > 0.0f;
        };
        const auto put = [&](const float* at, std::size_t step, float level) {
            for (std::size_t k = 0; k < 3; ++k) other[k * kWidth] = at[k * step];
            other[3 * kWidth] = level;
        };
        const auto isSlow = [&](Float3 v) { return dot(v, v) < slow_ * slow_; };
        if (isSlow(moved) && isSlow(moved - way)) {
            if (plane[kKnown * kWidth] > 0.0f) {
                const bool pressed = plane[kDistance * kWidth] < reach;
                const float level = plane[kLevel * kWidth];
                if (pressed && isOther(plane, kWidth, level)) return put(plane, kWidth, level);
                if (isOther(other, kWidth, other[3 * kWidth])) return;
            }
            const float* const fold = block_.rod.fold + i;
            for (const float* at : {fold, fold + 4 * pitch}) {
                // Only what pressed has some.
                if (block_.rod.load[i] == 0.0f) break;
                // It goes with the skin that was found.
                const Float3 n{at[0], at[pitch], at[2 * pitch]};
                const float level = at[3 * pitch] - dot(n, way);
                if (isOther(at, pitch, level)) return put(at, pitch, level);
            }
        }
        for (std::size_t k = 0; k < 4; ++k) other[k * kWidth] = 0.0f;
    }

    static constexpr std::size_t kDistance = 3, kWay = 5, kKnown = 8, kMeets = 10, kLevel = 11;
    static constexpr auto kFoldsBack = static_cast<float>(HAIRLOOM_BODY_FOLDS_BACK),
                          kFoldsAhead = static_cast<float>(HAIRLOOM_BODY_FOLDS_AHEAD);

    const MovingBody& body_;
    const RodBlock& block_;
    std::uint32_t substep_;
    float slow_;  ///< metres in a substep
    std::uint32_t lane_;
    BodyPlane* planes_;
    alignas(64) float asked_[kAsked][kWidth];
    std::uint32_t points_[kWidth], lanes_[kWidth];
    std::size_t count_ = 0;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
