// SPDX-License-Identifier: MIT
// External forces: gravity, drag of still air, wind.
#if defined(HAIRLOOM_RUNTIME_AIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_AIR_INL_H
#undef HAIRLOOM_RUNTIME_AIR_INL_H
#else
#define HAIRLOOM_RUNTIME_AIR_INL_H
#endif

#include <cmath>

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

void applyGravity(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    const V3 step = all3(context.gravityStep);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{block.firstFree} * kBlockLanes; i < end; i += kWidth) {
        store3(load3(block.previous, i) - step, block.previous, i);
    }
}

/// Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012,
/// Section 3.3).
template <bool kWind>
void applyAir(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V share = all(context.dragShare);
    const V tiny = all(1e-30f);
    const float now = static_cast<float>(context.index + 1) / static_cast<float>(context.count);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 atRoot{}, slope{};
        if constexpr (kWind) {
            const V t = all(now);
            const V3 r0 = load3(lanes.windRoot[0], lane), r1 = load3(lanes.windRoot[1], lane);
            const V3 t0 = load3(lanes.windTip[0], lane), t1 = load3(lanes.windTip[1], lane);
            atRoot = {lerp(r0.x, r1.x, t), lerp(r0.y, r1.y, t), lerp(r0.z, r1.z, t)};
            slope = V3{lerp(t0.x, t1.x, t), lerp(t0.y, t1.y, t), lerp(t0.z, t1.z, t)} - atRoot;
        }
        const float inverseLast = 1.0f / static_cast<float>(block.points - 1);
        V3 parent = load3(block.position, (block.firstFree - 1) * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 previous = load3(block.previous, i);
            V3 flow = previous - position;
            if constexpr (kWind) {
                const V along = all(static_cast<float>(p) * inverseLast);
                flow = flow + atRoot + slope * along;
            }
            const V3 tangent = position - parent;
            const V both = dot(flow, flow) * dot(tangent, tangent);
            const V parallel = dot(flow, tangent);
            const V sineSquared = hn::Max(both - parallel * parallel, hn::Zero(D())) / (both + tiny);
            const V part = share * hn::Sqrt(hn::Min(sineSquared, all(1.0f)));
            store3(previous - flow * part, block.previous, i);
            parent = position;
        }
    }
}

/// Velocity of the air at one place: the mean flow and its gusts or eddies.
HWY_INLINE V3 windAt(const Wind& wind, const float* phases, V3 place_ws) {
    const V3 mean = all3(wind.mean);
    if (wind.kind == WindKind::uniform) return mean;
    V waves = hn::Zero(D());
    V3 eddies = zero3();
    for (std::uint32_t m = 0; m < kWindModes; ++m) {
        const V wave = sineOfTurns(dot(place_ws, all3(wind.modes[m].waveVector)) + all(phases[m]));
        waves = waves + wave;
        eddies = eddies + all3(wind.modes[m].amplitude) * wave;
    }
    if (wind.kind != WindKind::gusting) return mean + eddies;
    // The sum of waves has the variance of kWindModes / 2; a sine of it, a quarter turn for its deviation,
    // keeps it smooth and within ±1.
    const V strength = sineOfTurns(waves * all(0.25f * std::sqrt(2.0f / static_cast<float>(kWindModes))));
    return mean * (all(1.0f) + strength * all(wind.strength));
}

void sampleWind(const BlockView& block, LaneFrame& lanes, float h, const Wind& wind, const float* from,
                const float* to) {
    const std::size_t tip = std::size_t{block.points - 1} * kBlockLanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 root = load3(lanes.root, lane);
        const V3 end = root + load3(block.position, tip + lane);
        const V substep = all(h);
        store3(windAt(wind, from, root) * substep, lanes.windRoot[0], lane);
        store3(windAt(wind, to, root) * substep, lanes.windRoot[1], lane);
        store3(windAt(wind, from, end) * substep, lanes.windTip[0], lane);
        store3(windAt(wind, to, end) * substep, lanes.windTip[1], lane);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
