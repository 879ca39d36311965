// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>

#include <algorithm>
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

// Words of SPIR-V (its specification, Section 2.3).
constexpr std::size_t kHeaderWords = 5;
constexpr std::uint32_t kOpTypeVoid = 19, kOpTypeForwardPointer = 39, kOpDecorate = 71, kNoContraction = 42;

/// Operations on floats that a driver may fuse: sums, products and their like, on vectors and matrices too.
bool mayFuse(std::uint32_t op) {
    constexpr std::array<std::uint32_t, 13> kOps{127, 129, 131, 133, 136, 140, 142,
                                                 143, 144, 145, 146, 147, 148};
    return std::ranges::find(kOps, op) != kOps.end();
}

/// The module in which each of them is rounded as it is written. Decorations stand before the first type.
std::vector<std::uint32_t> roundingEach(const std::vector<std::uint32_t>& words) {
    std::vector<std::uint32_t> decorations;
    std::size_t types = words.size();
    for (std::size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16u) {
        const std::uint32_t op = words[at] & 0xffffu;
        if (op >= kOpTypeVoid && op <= kOpTypeForwardPointer) types = std::min(types, at);
        if (mayFuse(op))
            decorations.insert(decorations.end(), {3u << 16u | kOpDecorate, words[at + 2], kNoContraction});
    }
    std::vector<std::uint32_t> result = words;
    result.insert(result.begin() + static_cast<std::ptrdiff_t>(types), decorations.begin(),
                  decorations.end());
    return result;
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
    return text.find(kRoundsEach) == std::string::npos ? words : roundingEach(words);
}

std::uint64_t spirvCompilerVersion() {
    return GLSLANG_VERSION_MAJOR * 10000u + GLSLANG_VERSION_MINOR * 100u + GLSLANG_VERSION_PATCH;
}

}  // namespace hairloom::gpu_simulation
