// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/hlsl_compiler.h"

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/gpu_simulation/hlsl_targets.h"

namespace hairloom::gpu_simulation {

const shaders::Source* findSource(std::string_view path) {
    for (const shaders::Source& source : shaders::sources()) {
        if (source.path == path) return &source;
    }
    return nullptr;
}

Result<std::vector<std::uint32_t>> compileHlsl(const std::string& path, const std::string& defines,
                                               gpu::Backend backend) {
    const shaders::Source* source = findSource(path);
    if (source == nullptr) return fail(fmt::format("no shader source '{}'", path));
    const std::string text = defines + std::string(source->text);
#ifdef _WIN32
    if (backend == gpu::Backend::Direct3D11) return compileToDxbc(path, text);
#endif
#ifdef HAIRLOOM_HAS_GLSLANG
    if (backend == gpu::Backend::Vulkan) return compileToSpirv(path, text);
#endif
    return fail(fmt::format("this program cannot compile kernels for {}", gpu::toString(backend)));
}

std::uint64_t hlslVersion(gpu::Backend backend) {
    auto hash = static_cast<std::uint64_t>(backend);
#ifdef HAIRLOOM_HAS_GLSLANG
    hash += 2 * spirvCompilerVersion();
#endif
    for (const shaders::Source& source : shaders::sources()) {
        hash = hashBytes(std::as_bytes(std::span(source.path)), hash);
        hash = hashBytes(std::as_bytes(std::span(source.text)), hash);
    }
    return hash;
}

}  // namespace hairloom::gpu_simulation
