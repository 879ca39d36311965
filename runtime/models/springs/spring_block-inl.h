// SPDX-License-Identifier: MIT
// A block of springs as its kernels read it.
#if defined(HAIRLOOM_RUNTIME_SPRING_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_SPRING_BLOCK_INL_H
#undef HAIRLOOM_RUNTIME_SPRING_BLOCK_INL_H
#else
#define HAIRLOOM_RUNTIME_SPRING_BLOCK_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// A copy that stores through vectors cannot change, as compilers take them to; with the one pitch that all
/// planes have.
HWY_INLINE SpringBlock localCopy(const SpringBlock& given) {
    SpringBlock block = given;
    for (Planes* const planes : {&block.position, &block.previous, &block.start, &block.stepDisplacement})
        planes->pitch = given.pitch;
    block.rest.pitch = block.target.pitch = given.pitch;
    return block;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
