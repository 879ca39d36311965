// SPDX-License-Identifier: MIT
// HLSL's names for plain types, so that a struct can be written once for shaders and C++. Only float4,
// float4x4, uint4, float and uint: three-component vectors are laid out differently in the two shader
// formats.
#ifndef HAIRLOOM_SHARED_TYPES_H
#define HAIRLOOM_SHARED_TYPES_H
#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

namespace hairloom::shaders {
// NOLINTBEGIN(readability-identifier-naming)
struct float4 {
    float x = 0, y = 0, z = 0, w = 0;
};
struct uint4 {
    std::uint32_t x = 0, y = 0, z = 0, w = 0;
};
/// Column-major; mul(matrix, vector) in the shader.
struct float4x4 {
    float m[16] = {};
};
using uint = std::uint32_t;
// NOLINTEND(readability-identifier-naming)
}  // namespace hairloom::shaders
#endif
#endif
