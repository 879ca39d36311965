// SPDX-License-Identifier: MIT
// The table of stages, compiled once for each instruction set. Each stage walks a block from root to tip and,
// at every point, over the block's lanes: neighbouring vectors are independent and hide each other's latency.
#include "runtime/kernels.h"

// Vector types stand in structs below, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/kernels/table.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "runtime/kernels/air-inl.h"
#include "runtime/kernels/bend-inl.h"
#include "runtime/kernels/collide-inl.h"
#include "runtime/kernels/integrate-inl.h"
#include "runtime/kernels/length-inl.h"
#include "runtime/kernels/roots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

const Kernels& kernelsOfTarget() {
    static const Kernels kTable{
        {moveRoots, applyGravity, applyAir<false>, applyAir<true>, applyPenalty, integrate, bendBack,
         holdLength, collideSwept, collide<false>, collide<true>, limitExtension},
        rescale,
        sampleWind,
        hwy::TargetName(HWY_TARGET)};
    return kTable;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(kernelsOfTarget);

const Kernels& kernels() {
    return HWY_DYNAMIC_DISPATCH(kernelsOfTarget)();
}

}  // namespace hairloom::runtime
#endif
