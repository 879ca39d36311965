// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Textures of cards as files.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/cards/level_arrays.h"

namespace hairloom::cards {

/// Of a level as PNG files beside STEM.*; none of a shell.
struct TextureFiles {
    std::string colour, normal;  ///< STEM_LEVEL_colour.png, albedo and coverage; STEM_LEVEL_normal.png
    std::vector<std::pair<std::string, std::vector<std::byte>>> files;  ///< names and contents
};
Result<TextureFiles> textureFilesOf(const Level& level, const LevelArrays& arrays, const std::string& stem,
                                    Cancel cancel = nullptr);

}  // namespace hairloom::cards
