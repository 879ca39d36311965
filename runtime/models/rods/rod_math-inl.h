// SPDX-License-Identifier: MIT
// shaders/rod.h for vectors of strands.
#if defined(HAIRLOOM_RUNTIME_ROD_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_MATH_INL_H
#undef HAIRLOOM_RUNTIME_ROD_MATH_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_MATH_INL_H
#endif

#include "engine/lanes-inl.h"
#include "engine/real-inl.h"
#include "hwy/highway.h"
#include "models/rods/rod_block.h"
#include "shaders/rod_constants.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

#define ROD_FUNCTION HWY_INLINE
#define ROD_INOUT(Type) Type&
#define ROD_OUT(Type) Type&
#define ROD_UNROLL
#define ROD_NUMBER(value) all(static_cast<float>(value))
#undef HAIRLOOM_ROD_FUNCTIONS
#undef HAIRLOOM_ROD_CONTACT_FUNCTIONS
#include "shaders/rod.h"
#include "shaders/rod_contact.h"
#undef ROD_FUNCTION
#undef ROD_INOUT
#undef ROD_OUT
#undef ROD_UNROLL
#undef ROD_NUMBER

HWY_INLINE RodForm noForm() {
    RodForm form;
    for (V& number : form.P) number = hn::Zero(D());
    for (V& number : form.R) number = hn::Zero(D());
    for (V& number : form.U) number = hn::Zero(D());
    form.gx = form.gu = form.force = zero3();
    return form;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
