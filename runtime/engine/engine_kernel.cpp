// SPDX-License-Identifier: MIT
// Inner loops that all models share, compiled once for each instruction set.
#include "engine/kernels.h"

// Vector types stand in structs, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/engine_kernel.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "engine/roots-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

const Kernels& kernelsOfTarget() {
    static const Kernels kTable{moveRoots, fastestOf, takeRoots, hwy::TargetName(HWY_TARGET),
                                HWY_NATIVE_FMA != 0};
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
