// SPDX-License-Identifier: MIT
// What position Verlet does to the free points in a substep, from damping to the move: each part by itself,
// and all of them in one pass.
#if defined(HAIRLOOM_RUNTIME_MOTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_MOTION_INL_H
#undef HAIRLOOM_RUNTIME_MOTION_INL_H
#else
#define HAIRLOOM_RUNTIME_MOTION_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// The air's way in a substep along a strip of strands: at the root, and how much more at the tip.
struct AirWay {
    V3 atRoot, slope;
};

HWY_INLINE AirWay airWay(const LaneFrame& lanes, const SubstepContext& context, std::size_t lane) {
    const V t = all(static_cast<float>(context.index + 1) / static_cast<float>(context.count));
    const V3 r0 = load3(lanes.windRoot[0], lane), r1 = load3(lanes.windRoot[1], lane);
    const V3 t0 = load3(lanes.windTip[0], lane), t1 = load3(lanes.windTip[1], lane);
    const V3 atRoot{lerp(r0.x, r1.x, t), lerp(r0.y, r1.y, t), lerp(r0.z, r1.z, t)};
    return {atRoot, V3{lerp(t0.x, t1.x, t), lerp(t0.y, t1.y, t), lerp(t0.z, t1.z, t)} - atRoot};
}

/// Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012,
/// Section 3.3). The share of `flow`, the air's way past a point, that it gains.
HWY_INLINE V blownShare(V3 flow, V3 tangent, V share) {
    const V both = dot(flow, flow) * dot(tangent, tangent);
    const V parallel = dot(flow, tangent);
    const V sineSquared =
        hn::Max(hn::NegMulAdd(parallel, parallel, both), hn::Zero(D())) / (both + all(1e-30f));
    return share * hn::Sqrt(hn::Min(sineSquared, all(1.0f)));
}

/// In this order: slows motion relative to the moving root, so that damping acts on velocity alone and leaves
/// what holds the hair at rest untouched; then the forces of air and gravity; then position Verlet (Rünz
/// 2012, Eq. 10).
template <bool kDamped, Air kAir, bool kHeavy, bool kAdvances>
void moveFree(const BlockView& given, LaneFrame& lanes, const SubstepContext& context) {
    const BlockView block = localCopy(given);
    const V lost = all(1.0f - context.velocityShare), share = all(context.dragShare);
    const V3 gravity = all3(context.gravityStep);
    float shareOfWay[kMaxPoints];  // of each point, from root to tip
    if constexpr (kAir == Air::moving) {
        const float inverseLast = 1.0f / static_cast<float>(block.points - 1);
        for (std::uint32_t p = 0; p < block.points; ++p) shareOfWay[p] = static_cast<float>(p) * inverseLast;
    }
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const V3 step = load3(lanes.rootStep, lane);
        AirWay air{};
        if constexpr (kAir == Air::moving) air = airWay(lanes, context, lane);
        V3 parent = load3(block.position, std::size_t{block.firstFree - 1} * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            V3 previous = load3(block.previous, i);
            if constexpr (kDamped) previous = mulAdd(position - previous - step, lost, previous);
            if constexpr (kAir != Air::none) {
                V3 flow = previous - position;
                if constexpr (kAir == Air::moving)
                    flow = flow + mulAdd(air.slope, all(shareOfWay[p]), air.atRoot);
                previous = negMulAdd(flow, blownShare(flow, position - parent, share), previous);
                parent = position;
            }
            if constexpr (kHeavy) previous = previous - gravity;
            if constexpr (kAdvances) {
                const V3 start = position - step;
                store3(start + (position - previous), block.position, i);
                previous = start;
            }
            store3(previous, block.previous, i);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
