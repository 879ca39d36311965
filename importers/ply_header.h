// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a PLY file says it holds.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

std::size_t sizeOf(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> listSize;  ///< type of the count before a list; empty for single values
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of the first property of one of these names.
    std::optional<std::size_t> find(std::initializer_list<const char*> names) const;
};

enum class PlyEncoding { Text, LittleEndian, BigEndian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Text;
    std::vector<PlyElement> elements;
    std::uint64_t bodyOffset = 0;  ///< bytes
    std::uint64_t lines = 0;       ///< before the body
};

/// Errors, with the line: what is no PLY header.
Result<PlyHeader> readPlyHeader(const std::string& file, std::span<const std::byte> bytes);

}  // namespace hairloom
