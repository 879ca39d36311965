// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A view of a colour config as a table that a device looks up: it cannot run OpenColorIO itself.

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/math.h"
#include "core/render/colour_transform.h"

namespace hairloom::render {

/// Light by its logarithm, with a straight toe so that black is a node, against code values.
struct DisplayTable {
    std::uint32_t side = 2;  ///< nodes along a channel
    float toe = 1;           ///< a channel x is at log2(1 + toe x) of log2(1 + toe top), of side − 1
    float top = 1;           ///< the most light, exposed, that code values tell apart
    /// Red changes fastest; the fourth number is unused. Not clamped: clipped values would bend between
    /// nodes.
    std::vector<std::array<float, 4>> codes;
    int worst = 0;  ///< 255ths that it is off by, of kProbes colours

    /// Code values 0…1 of exposed light, as the shader display_table.frag has them.
    Vec3f lookUp(const Vec3f& light) const;
};

/// The smallest of 33, 65 and 129 nodes a side that is within one of 255 code values; else 129. At most 34
/// MB, and about two seconds of one core.
DisplayTable bakeDisplayTable(const ColourTransform& toDisplay);

/// 255ths that a table of this view is off by, of kProbes colours.
int displayTableError(const DisplayTable& table, const ColourTransform& toDisplay);

}  // namespace hairloom::render
