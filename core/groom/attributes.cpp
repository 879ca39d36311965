// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/attributes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace hairloom {
namespace {

constexpr std::array<std::string_view, std::variant_size_v<AttributeData>> kTypeNames = {
    "float", "float2", "float3", "float4", "int32", "uint32", "uint8"};

template <std::size_t... Index>
AttributeData emptyAt(std::size_t wanted, std::index_sequence<Index...>) {
    AttributeData data;
    ((wanted == Index ? static_cast<void>(data.emplace<Index>()) : static_cast<void>(0)), ...);
    return data;
}

}  // namespace

std::string_view typeName(const AttributeData& data) {
    return kTypeNames[data.index()];
}

Result<AttributeData> emptyOfType(std::string_view name) {
    for (std::size_t i = 0; i < kTypeNames.size(); ++i) {
        if (kTypeNames[i] == name) {
            return emptyAt(i, std::make_index_sequence<std::variant_size_v<AttributeData>>());
        }
    }
    return fail(fmt::format("'{}' is not an attribute type", name),
                fmt::format("expected one of {}", fmt::join(kTypeNames, ", ")));
}

std::size_t sizeOf(const AttributeData& data) {
    return std::visit([](const auto& array) { return array.size(); }, data);
}

Version versionOf(const AttributeData& data) {
    return std::visit([](const auto& array) { return array.version(); }, data);
}

std::string maskAttribute(std::uint32_t number) {
    return fmt::format("mask.{}", number);
}

}  // namespace hairloom
