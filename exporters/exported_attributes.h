// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Attributes of strands and points under the names that other programs know, for formats that carry any.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exporters/prepared_strands.h"

namespace hairloom {

struct ExportedAttribute {
    enum class Type : std::uint8_t { Number, Whole, Flag };
    std::string name;
    bool perPoint = false;
    Type type = Type::Number;
    std::uint32_t components = 1;
    std::vector<float> numbers;       ///< of Number
    std::vector<std::int32_t> whole;  ///< of the others
    bool isColour = false;
};

/// Of the strands that are written: groom_id, groom_group_id, groom_guide, groom_root_uv and groom_color
/// where the groom has them (an id always), then all that Hairloom gives no meaning to, in order of name.
/// Points of resampled strands have nothing but colours.
std::vector<ExportedAttribute> exportedAttributes(const Groom& groom, const PreparedStrands& strands);

/// About what a binary file of them takes, in bytes, so that it grows without being copied.
std::size_t roomOf(const PreparedStrands& strands, std::span<const ExportedAttribute> attributes);

}  // namespace hairloom
