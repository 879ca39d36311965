// SPDX-License-Identifier: MIT
// The wind at the strands of a block.
#if defined(HAIRLOOM_RUNTIME_AIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_AIR_INL_H
#undef HAIRLOOM_RUNTIME_AIR_INL_H
#else
#define HAIRLOOM_RUNTIME_AIR_INL_H
#endif

#include "engine/lanes-inl.h"
#include "engine/wind-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

void sampleWind(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context, const float* from,
                const float* to) {
    const Wind& wind = *context.wind;
    const auto last = static_cast<float>(context.count);
    const std::size_t tip = std::size_t{block.points - 1} * kBlockLanes;
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const V3 root = load3(lanes.root, lane);
        const V3 end = root + load3(block.position, tip + lane);
        const V substep = all(context.h);
        store3(shelteredWindAt(wind, from, root, context, 0.0f) * substep, springLanes(lanes).windRoot[0],
               lane);
        store3(shelteredWindAt(wind, to, root, context, last) * substep, springLanes(lanes).windRoot[1],
               lane);
        store3(shelteredWindAt(wind, from, end, context, 0.0f) * substep, springLanes(lanes).windTip[0],
               lane);
        store3(shelteredWindAt(wind, to, end, context, last) * substep, springLanes(lanes).windTip[1], lane);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
