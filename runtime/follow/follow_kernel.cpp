// SPDX-License-Identifier: MIT
// The kernels of follow hairs, compiled once for each instruction set.
#include "follow/follow_kernels.h"

// Vector types stand in structs of lanes-inl.h, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "follow/follow_kernel.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "follow/follow-inl.h"
#include "follow/shown-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

const FollowKernels& followKernelsOfTarget() {
    constexpr bool kFused = HWY_NATIVE_FMA != 0;
    static const FollowKernels kTable{kWidth,   kFused,  fillWisps,     sumRows,   tangents,
                                      toHalves, toNorms, toSignedNorms, growBounds};
    return kTable;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(followKernelsOfTarget);

const FollowKernels& followKernels() {
    return HWY_DYNAMIC_DISPATCH(followKernelsOfTarget)();
}

}  // namespace hairloom::runtime
#endif
