// SPDX-License-Identifier: MIT
// Integration of motion.
#if defined(HAIRLOOM_RUNTIME_INTEGRATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_INTEGRATE_INL_H
#undef HAIRLOOM_RUNTIME_INTEGRATE_INL_H
#else
#define HAIRLOOM_RUNTIME_INTEGRATE_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Position Verlet (Rünz 2012, Eq. 10), where the displacement relative to the moving root decays with the
/// damping.
void integrate(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V share = all(context.velocityShare);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 step = load3(lanes.rootStep, lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 moved = position - load3(block.previous, i) - step;
            store3(position - step, block.previous, i);
            store3(position + moved * share, block.position, i);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
