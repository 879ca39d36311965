// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// HLSL compute shaders to SPIR-V or DXBC while the program runs: with glslang as a library, so that a
// permutation can be made on a machine without any shader compiler, or with Windows' own. The flags are those
// of shaders/CMakeLists.txt. The mingw-w64 build has no glslang and makes kernels for Direct3D only.

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/gpu/types.h"

namespace hairloom::gpu_simulation {

/// Compiles `defines`, lines of #define, followed by the file `path` of shaders::sources(), from which the
/// files that it includes come as well. May be called from several threads at a time. Errors: what the
/// compiler says, or that the program has none for this backend.
Result<std::vector<std::uint32_t>> compileHlsl(const std::string& path, const std::string& defines,
                                               gpu::Backend backend);

/// Of the sources, the compiler and the backend: another value, another result.
std::uint64_t hlslVersion(gpu::Backend backend);

}  // namespace hairloom::gpu_simulation
