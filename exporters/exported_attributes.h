// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Attributes of strands and points under the names that other programs know, for formats that carry any. One
// place gives names: no file has a name twice.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exporters/prepared_strands.h"
#include "importers/strand_parts.h"

namespace hairloom {

struct ExportedAttribute {
    enum class Type : std::uint8_t { Number, Whole, Flag };
    std::string name;      ///< legal in the file, and of no other attribute
    std::string original;  ///< the groom's name, where the file's is another; else empty
    bool perPoint = false;
    Type type = Type::Number;
    std::uint32_t components = 1;
    std::vector<float> numbers;       ///< of Number; lengths and places in the file's unit and axes
    std::vector<std::int32_t> whole;  ///< of the others
    bool isColour = false;

    std::size_t elements() const {
        return (type == Type::Number ? numbers.size() : whole.size()) / components;
    }
};

/// What a format makes of names.
struct ExportNames {
    NameGiver::Legal isLegal;
    std::vector<std::string_view> taken;  ///< by what the format writes beside attributes
    bool hasOperators = false;            ///< what operators start from goes along
    bool isUnreal = false;                ///< widths are "groom_width", too, and layers groups without others
};
/// `operators`: the file has these.
ExportNames usdNames(bool operators = false);
ExportNames alembicNames(bool unreal);
ExportNames plyNames();

/// Of the strands that are written: groom_id, groom_group_id, groom_guide, groom_root_uv and groom_color
/// where the groom has them (an id always), then all that Hairloom gives no meaning to, in order of name. An
/// attribute of the groom that has one of these names is written in its place, with the author's values.
/// Points of resampled strands have nothing but colours and widths. What had to be changed becomes a finding
/// of `strands`, which get their names.
std::vector<ExportedAttribute> exportedAttributes(const Groom& groom, PreparedStrands& strands,
                                                  const ExportNames& names);

/// The group of each strand as Unreal shows it: its name, else that of its layer; empty where all have the
/// name that layers have by themselves.
std::vector<std::string> unrealGroupNames(const Groom& groom, const PreparedStrands& strands);

/// About what a binary file of them takes, in bytes, so that it grows without being copied.
std::size_t roomOf(const PreparedStrands& strands, std::span<const ExportedAttribute> attributes);

}  // namespace hairloom
