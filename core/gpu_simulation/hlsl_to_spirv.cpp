// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>

#include <array>

#include "core/gpu_simulation/hlsl_targets.h"

namespace hairloom::gpu_simulation {
namespace {

/// Sources are known by their file's name.
class Includer final : public glslang::TShader::Includer {
  public:
    IncludeResult* includeLocal(const char* name, const char*, std::size_t) override {
        const shaders::Source* source = findSource(name);
        if (source == nullptr) return nullptr;
        // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): given back to releaseInclude().
        return new IncludeResult(name, source->text.data(), source->text.size(), nullptr);
    }
    void releaseInclude(IncludeResult* result) override { delete result; }
};

/// glslang wants to be started once a process.
void startCompiler() {
    static const bool kStarted = glslang::InitializeProcess();
    static_cast<void>(kStarted);
}

// As --shift-…-binding in shaders/CMakeLists.txt.
constexpr unsigned kTextureShift = 16, kSamplerShift = 48, kWriteShift = 64;

void describe(glslang::TShader& shader) {
    shader.setEntryPoint("main");
    shader.setSourceEntryPoint("main");
    shader.setEnvInput(glslang::EShSourceHlsl, EShLangCompute, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
    shader.setShiftBinding(glslang::EResUbo, 0);
    shader.setShiftBinding(glslang::EResTexture, kTextureShift);
    shader.setShiftBinding(glslang::EResSampler, kSamplerShift);
    shader.setShiftBinding(glslang::EResUav, kWriteShift);
    shader.setAutoMapBindings(true);
    shader.setHlslIoMapping(true);
}

}  // namespace

Result<std::vector<std::uint32_t>> compileToSpirv(const std::string& path, const std::string& text) {
    startCompiler();
    const std::array<const char*, 1> strings{text.data()};
    const std::array<int, 1> lengths{static_cast<int>(text.size())};
    const std::array<const char*, 1> names{path.c_str()};
    constexpr auto kMessages =
        static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgReadHlsl | EShMsgHlslOffsets);
    constexpr int kDefaultVersion = 500;
    glslang::TShader shader(EShLangCompute);
    shader.setStringsWithLengthsAndNames(strings.data(), lengths.data(), names.data(), 1);
    describe(shader);
    Includer includer;
    if (!shader.parse(GetDefaultResources(), kDefaultVersion, false, kMessages, includer))
        return fail(fmt::format("shader '{}' does not compile: {}", path, shader.getInfoLog()));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages) || !program.mapIO())
        return fail(fmt::format("shader '{}' does not link: {}", path, program.getInfoLog()));
    std::vector<std::uint32_t> words;
    glslang::SpvOptions options;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), words, &options);
    if (words.empty()) return fail(fmt::format("shader '{}' became no SPIR-V", path));
    return words;
}

std::uint64_t spirvCompilerVersion() {
    return GLSLANG_VERSION_MAJOR * 10000u + GLSLANG_VERSION_MINOR * 100u + GLSLANG_VERSION_PATCH;
}

}  // namespace hairloom::gpu_simulation
