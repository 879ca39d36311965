// SPDX-License-Identifier: MIT
#include "runtime/kernels.h"

// Vector types stand in structs below, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/kernels.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "runtime/stages-inl.h"

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(kernelsOfTarget);

const Kernels& kernels() {
    return HWY_DYNAMIC_DISPATCH(kernelsOfTarget)();
}

}  // namespace hairloom::runtime
#endif
