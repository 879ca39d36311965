// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The compilers behind compileHlsl(). `text` is what is compiled, `path` its name in messages; the function
// is main.

#include "core/gpu_simulation/hlsl_compiler.h"
#include "shaders/shaders.h"

namespace hairloom::gpu_simulation {

/// Nothing where the program has no such source.
const shaders::Source* findSource(std::string_view path);

Result<std::vector<std::uint32_t>> compileToSpirv(const std::string& path, const std::string& text);
std::uint64_t spirvCompilerVersion();

/// With the system's compiler. Windows only.
Result<std::vector<std::uint32_t>> compileToDxbc(const std::string& path, const std::string& text);

}  // namespace hairloom::gpu_simulation
