// SPDX-License-Identifier: MIT
#pragma once
// Numbers of the C interface as the engine has them, and what is said where there are too many or too few.

#include <algorithm>
#include <cstddef>
#include <string>

#include "play/instance.h"

namespace hairloom::runtime {

inline Refusal wrongSize(const std::string& what, std::size_t size, std::size_t wanted) {
    return {HL_WRONG_SIZE, std::to_string(size) + " " + what + "; expected " + std::to_string(wanted)};
}

inline Float3 float3At(const float* values, std::size_t index) {
    return {values[3 * index], values[3 * index + 1], values[3 * index + 2]};
}

inline Matrix34 matrixAt(const float* values, std::size_t index) {
    Matrix34 matrix;
    std::copy_n(values + 12 * index, 12, matrix.begin());
    return matrix;
}

/// The frame as one that goes straight to its end.
inline hl_frame withoutInner(hl_frame frame) {
    frame.inner_count = 0;
    return frame;
}

}  // namespace hairloom::runtime
