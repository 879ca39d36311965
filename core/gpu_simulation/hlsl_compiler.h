// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// HLSL compute shaders to SPIR-V while the program runs, with glslang as a library: a permutation can be made
// on a machine without any shader compiler. The flags are those of shaders/CMakeLists.txt.

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom::gpu_simulation {

/// Compiles `defines`, lines of #define, followed by the file `path` of shaders::sources(), from which the
/// files that it includes come as well. May be called from several threads at a time. Errors: what the
/// compiler says.
Result<std::vector<std::uint32_t>> compileHlsl(const std::string& path, const std::string& defines);

/// Of the sources and the compiler: another value, another result.
std::uint64_t hlslVersion();

}  // namespace hairloom::gpu_simulation
