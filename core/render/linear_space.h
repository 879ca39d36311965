// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

namespace hairloom::render {

/// What RGB of linear light mean. By default those that everything here is computed in.
struct LinearSpace {
    /// CIE 1931 x and y of red, green, blue and white.
    std::array<float, 8> chromaticities{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    /// A name of the ASWF's Color Interop Forum, which other programs know. Empty: it has none.
    std::string interopId = "lin_rec709_scene";
};

}  // namespace hairloom::render
