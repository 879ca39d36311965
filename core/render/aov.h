// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a picture tells besides light, as layers of an OpenEXR.

#include <array>
#include <span>
#include <string_view>

#include "core/render/exr.h"

namespace hairloom::render {

enum class Aov {
    depth,     ///< depth.Z: metres along the view; infinite where nothing is
    id,        ///< id.X: number of the hair among those that are drawn, from 0; -1 where none is
    velocity,  ///< velocity.X, .Y: pixels that it has moved since a frame ago, to the right and down
    albedo,    ///< albedo.R, .G, .B: linear; of light in fibres the colour that much such hair has
};
inline constexpr std::array<std::string_view, 4> kAovNames{"depth", "id", "velocity", "albedo"};

/// Of a picture's surface, those with these names. Errors: another name; a hair beyond 16,777,216, whose
/// number no 32-bit float holds.
Result<std::vector<ExrLayer>> aovLayers(std::span<const std::string> names,
                                        std::span<const SurfacePixel> surface);

}  // namespace hairloom::render
