// SPDX-License-Identifier: MIT
// The rods' stage, compiled once for each instruction set.
#include "models/rods/rod_block.h"

// Vector types stand in structs below, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/rods/rod_kernel.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "models/rods/rod-inl.h"
#include "models/rods/rod_finish-inl.h"
#include "models/rods/rod_look-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

RodKernel rodKernelOfTarget() {
    return {stepRods, (sizeof(RodPoint) + sizeof(BodyPlane)) / sizeof(float)};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(rodKernelOfTarget);

RodKernel rodKernel() {
    return HWY_DYNAMIC_DISPATCH(rodKernelOfTarget)();
}

}  // namespace hairloom::runtime
#endif
