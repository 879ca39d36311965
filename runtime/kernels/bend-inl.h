// SPDX-License-Identifier: MIT
// Angular springs.
#if defined(HAIRLOOM_RUNTIME_BEND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_BEND_INL_H
#undef HAIRLOOM_RUNTIME_BEND_INL_H
#else
#define HAIRLOOM_RUNTIME_BEND_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Angular springs: each point is pulled to its rest place beside its parent (Rünz 2012, Eq. 4 and the
/// cheaper of its two directions), by the share `pull` of its offset from there and the share `damp` of that
/// offset's change; then the frame of reference turns with the segment. The parent feels no reaction: without
/// the damper each segment would drive the next one at its resonance.
void bendBack(const BlockView& block, LaneFrame& lanes, const SubstepContext&) {
    alignas(64) float carried[4][kBlockLanes];
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth)
        store4(load4(lanes.rotation, lane), carried, lane);
    for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const std::size_t s = i - kBlockLanes;
            const V4 frame = load4(carried, lane);
            const V3 target = rotate(frame, load3(block.rest, s));
            const V3 parent = load3(block.position, s);
            const V3 offset = target - (load3(block.position, i) - parent);
            const V3 change = offset - load3(block.offset, s);
            const V3 left =
                offset - offset * hn::Load(D(), block.pull + s) - change * hn::Load(D(), block.damp + s);
            const V3 bent = target - left;
            store3(left, block.offset, s);
            store3(parent + bent, block.position, i);
            store4(multiply(shortestArc(target, bent), frame), carried, lane);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
