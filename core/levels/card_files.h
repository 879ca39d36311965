// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What files of card meshes have in common: textures beside them.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/cards/level_arrays.h"
#include "core/render/image.h"

namespace hairloom {

using NamedImages = std::vector<std::pair<std::string, render::Image>>;

/// Of a level as files beside STEM.*; empty of a shell, which has none.
struct LevelTextures {
    std::string colour, normal;  ///< STEM_LEVEL_colour.png, albedo and coverage; STEM_LEVEL_normal.png
    NamedImages images;
};
LevelTextures texturesOf(const cards::Level& level, const cards::LevelArrays& arrays,
                         const std::string& stem);

/// The first of the files is the one that was asked for; images go beside it, as PNG. The names of all but
/// the first. Errors: files that cannot be written; then none is.
Result<std::vector<std::string>> writeTogether(
    std::vector<std::pair<std::filesystem::path, std::vector<std::byte>>> files, const NamedImages& images);

}  // namespace hairloom
