// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which attributes of hair are lengths and places, so that they follow the unit and axis of a file.

#include <cstdint>
#include <string_view>

namespace hairloom {

enum class AttributeUnit : std::uint8_t {
    None,
    Length,    ///< a number in the file's unit
    Position,  ///< three, in its unit and axes
    Vector,    ///< likewise, without a place
};

/// By the names that programs use: widths, radii and lengths of hair, rest positions, velocities. Letters may
/// be small or large. `components` numbers make one value.
AttributeUnit attributeUnit(std::string_view name, std::uint32_t components);

}  // namespace hairloom
