// SPDX-License-Identifier: MIT
// What position Verlet does to the free points in a substep, from damping to the move: each part by itself,
// and all of them in one pass.
#if defined(HAIRLOOM_RUNTIME_MOTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_MOTION_INL_H
#undef HAIRLOOM_RUNTIME_MOTION_INL_H
#else
#define HAIRLOOM_RUNTIME_MOTION_INL_H
#endif

#include <algorithm>

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// The air's way in a substep along a strip of strands: at the root, and how much more at the tip.
struct AirDisplacement {
    V3 atRoot, slope;
};

HWY_INLINE AirDisplacement airDisplacement(const LaneFrame& lanes, const SubstepContext& context,
                                           std::size_t lane) {
    const V t = all(static_cast<float>(context.index + 1) / static_cast<float>(context.count));
    const V3 r0 = load3(springLanes(lanes).windRoot[0], lane),
             r1 = load3(springLanes(lanes).windRoot[1], lane);
    const V3 t0 = load3(springLanes(lanes).windTip[0], lane), t1 = load3(springLanes(lanes).windTip[1], lane);
    const V3 atRoot{lerp(r0.x, r1.x, t), lerp(r0.y, r1.y, t), lerp(r0.z, r1.z, t)};
    return {atRoot, V3{lerp(t0.x, t1.x, t), lerp(t0.y, t1.y, t), lerp(t0.z, t1.z, t)} - atRoot};
}

/// Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012,
/// Section 3.3). The share of `flow`, the air's displacement past a point, that it gains: the root of
/// share² · sin². The square of the share divides what stands below, which is known before what stands above.
HWY_INLINE V blownShare(V3 flow, V3 tangent, V inverseShareSquared) {
    const V both = dot(flow, flow) * dot(tangent, tangent);
    const V parallel = dot(flow, tangent);
    const V across = hn::Max(hn::NegMulAdd(parallel, parallel, both), hn::Zero(D()));
    return hn::Sqrt(across / hn::MulAdd(both, inverseShareSquared, all(1e-30f)));
}

/// What moveFree() finds and leaves in `previous`: the position of a substep ago or the way since; or it
/// makes the move.
enum class Motion { position, displacement, integrated };

/// In this order: slows motion relative to the moving root, so that damping acts on velocity alone and leaves
/// what holds the hair at rest untouched; then the forces of air and gravity; then position Verlet (Rünz
/// 2012, Eq. 10).
template <bool kDamped, Air kAir, bool kHeavy, Motion kFrom, Motion kTo>
void moveFree(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    const V kept = all(context.velocityShare), lost = all(1.0f - context.velocityShare);
    const V inverseShareSquared = all(1.0f / std::max(context.dragShare * context.dragShare, 1e-30f));
    const V3 gravity = all3(context.gravityStep);
    float fractionAlong[kMaxPoints];  // of each point, from root to tip
    if constexpr (kAir == Air::moving) {
        const float inverseLast = 1.0f / static_cast<float>(block.points - 1);
        for (std::uint32_t p = 0; p < block.points; ++p)
            fractionAlong[p] = static_cast<float>(p) * inverseLast;
    }
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const V3 step = load3(lanes.rootDisplacement, lane), lostStep = step * lost;
        AirDisplacement air{};
        if constexpr (kAir == Air::moving) air = airDisplacement(lanes, context, lane);
        V3 parent = load3(block.position, std::size_t{block.firstFree - 1} * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            V3 displacement = load3(block.previous, i);
            if constexpr (kFrom == Motion::position) displacement = position - displacement;
            if constexpr (kDamped) displacement = mulAdd(displacement, kept, lostStep);
            if constexpr (kAir != Air::none) {
                V3 flow = zero3();
                if constexpr (kAir == Air::moving)
                    flow = mulAdd(air.slope, all(fractionAlong[p]), air.atRoot);
                flow = flow - displacement;
                displacement =
                    mulAdd(flow, blownShare(flow, position - parent, inverseShareSquared), displacement);
                parent = position;
            }
            if constexpr (kHeavy) displacement = displacement + gravity;
            if constexpr (kTo == Motion::displacement) store3(displacement, block.previous, i);
            if constexpr (kTo == Motion::position) store3(position - displacement, block.previous, i);
            if constexpr (kTo == Motion::integrated) {
                const V3 start = position - step;
                store3(start + displacement, block.position, i);
                store3(start, block.previous, i);
            }
        }
    }
}

void rescale(const SpringBlock& block, float factor) {
    const V share = all(factor);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = 0; i < end; i += kWidth) {
        const V3 position = load3(block.position, i);
        store3(position - (position - load3(block.previous, i)) * share, block.previous, i);
    }
    if (!block.tension) return;
    for (std::size_t i = 0; i < end; i += kWidth)
        hn::Store(hn::Load(D(), block.tension + i) * share * share, D(), block.tension + i);
}

void startHalfway(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{block.firstFree} * kBlockLanes; i < end; i += kWidth) {
        const V3 from = load3(block.previous, i);
        store3(mulAdd(load3(block.position, i) - from, all(0.5f), from), block.position, i);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
