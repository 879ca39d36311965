// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/reflection.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace hairloom::gpu::vulkan {
namespace {

// SPIR-V 1.3 specification, sections 3.20 and 3.32: the few numbers needed here.
enum Op : std::uint32_t {
    kTypeImage = 25,
    kTypeSampler = 26,
    kTypeStruct = 30,
    kTypePointer = 32,
    kVariable = 59,
    kDecorate = 71
};
enum Decoration : std::uint32_t { kBlock = 2, kBufferBlock = 3, kNonWritable = 24, kBinding = 33 };
enum StorageClass : std::uint32_t { kUniformConstant = 0, kUniform = 2, kStorageBuffer = 12 };
constexpr std::uint32_t kMagic = 0x07230203;
constexpr std::uint32_t kDimBuffer = 5;

struct Type {
    std::uint32_t op = 0;
    std::uint32_t pointee = 0;
    bool isBuffer = false;
    bool isStorage = false;
};

struct Module {
    std::map<std::uint32_t, Type> types;
    std::map<std::uint32_t, std::uint32_t> bindings;  // id -> binding
    std::map<std::uint32_t, bool> bufferBlocks;
    struct Variable {
        std::uint32_t id, pointerType, storage;
    };
    std::vector<Variable> variables;
};

void readInstruction(Module& module, std::uint32_t op, std::span<const std::uint32_t> w) {
    if (op == kTypeImage && w.size() >= 8) {
        module.types[w[1]] = {op, 0, w[3] == kDimBuffer, w[7] == 2};
    } else if (op == kTypeSampler || op == kTypeStruct) {
        if (w.size() >= 2) module.types[w[1]] = {op, 0, false, false};
    } else if (op == kTypePointer && w.size() >= 4) {
        module.types[w[1]] = {op, w[3], false, false};
    } else if (op == kVariable && w.size() >= 4) {
        module.variables.push_back({w[2], w[1], w[3]});
    } else if (op == kDecorate && w.size() >= 3) {
        if (w[2] == kBinding && w.size() >= 4) module.bindings[w[1]] = w[3];
        if (w[2] == kBufferBlock) module.bufferBlocks[w[1]] = true;
    }
}

Result<Module> readModule(std::span<const std::uint32_t> words) {
    if (words.size() < 5 || words[0] != kMagic) return fail("not SPIR-V", "the magic number 0x07230203");
    Module module;
    for (std::size_t at = 5; at < words.size();) {
        const std::uint32_t length = words[at] >> 16u;
        if (length == 0 || length > words.size() - at) return fail("truncated SPIR-V");
        readInstruction(module, words[at] & 0xffffu, words.subspan(at, length));
        at += length;
    }
    return module;
}

Result<VkDescriptorType> descriptorType(const Module& module, const Module::Variable& variable) {
    const auto pointer = module.types.find(variable.pointerType);
    if (pointer == module.types.end()) return fail("a resource of unknown type");
    const auto found = module.types.find(pointer->second.pointee);
    if (found == module.types.end()) return fail("an array of resources", "one resource a register");
    const Type& type = found->second;
    switch (type.op) {
        case kTypeStruct: {
            const bool storage =
                variable.storage == kStorageBuffer || module.bufferBlocks.contains(pointer->second.pointee);
            return storage ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        }
        case kTypeSampler:
            return VK_DESCRIPTOR_TYPE_SAMPLER;
        case kTypeImage:
            if (type.isBuffer) {
                return type.isStorage ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                                      : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
            }
            return type.isStorage ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        default:
            return fail("a resource of unknown type");
    }
}

}  // namespace

ShaderRegister toRegister(std::uint32_t binding) {
    if (binding >= kWriteShift) return {Binding::Kind::UnorderedAccess, binding - kWriteShift};
    if (binding >= kSamplerShift) return {Binding::Kind::Sampler, binding - kSamplerShift};
    if (binding >= kReadShift) return {Binding::Kind::ShaderResource, binding - kReadShift};
    return {Binding::Kind::ConstantBuffer, binding - kConstantShift};
}

Result<std::vector<ReflectedBinding>> reflect(std::span<const std::uint32_t> words,
                                              VkShaderStageFlags stage) {
    const auto read = readModule(words);
    if (!read) return tl::unexpected(read.error());
    const Module& module = *read;
    std::vector<ReflectedBinding> result;
    for (const auto& variable : module.variables) {
        const bool resource = variable.storage == kUniformConstant || variable.storage == kUniform ||
                              variable.storage == kStorageBuffer;
        const auto binding = module.bindings.find(variable.id);
        if (!resource || binding == module.bindings.end()) continue;
        const auto type = descriptorType(module, variable);
        if (!type) return tl::unexpected(type.error());
        result.push_back({binding->second, *type, stage});
    }
    return result;
}

std::vector<std::uint32_t> withConstantsInStorage(std::span<const std::uint32_t> words) {
    const auto module = readModule(words);
    if (!module) return {words.begin(), words.end()};
    std::set<std::uint32_t> variables, structs;
    for (const auto& variable : module->variables) {
        const auto type = descriptorType(*module, variable);
        const bool bound = module->bindings.contains(variable.id);
        if (variable.storage != kUniform || !bound || !type || *type != VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER)
            continue;
        variables.insert(variable.id);
        structs.insert(module->types.at(variable.pointerType).pointee);
    }
    std::vector<std::uint32_t> result(words.begin(), words.begin() + 5);
    for (std::size_t at = 5; at < words.size();) {
        const std::uint32_t length = words[at] >> 16u;
        const auto instruction = words.subspan(at, length);
        const std::size_t begin = result.size();
        result.insert(result.end(), instruction.begin(), instruction.end());
        at += length;
        if ((instruction[0] & 0xffffu) != kDecorate || length < 3) continue;
        if (instruction[2] == kBlock && structs.contains(instruction[1])) result[begin + 2] = kBufferBlock;
        if (instruction[2] == kBinding && variables.contains(instruction[1]))
            result.insert(result.end(), {(3u << 16u) | kDecorate, instruction[1], kNonWritable});
    }
    return result;
}

}  // namespace hairloom::gpu::vulkan
