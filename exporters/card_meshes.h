// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards and shells as files of meshes for programs that read no glTF, by hairloom-mesh-writer, a program
// beside the running one.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/cards/character.h"
#include "core/cards/levels.h"
#include "exporters/card_files.h"

namespace hairloom {

enum class CardMeshFormat : std::uint8_t {
    obj,  ///< metres; materials in a .mtl beside it
    fbx,  ///< centimetres, as FBX has them; joints and weights
};

/// What of the chain is no strands, a mesh for each level, the nearest NAME_LOD0, and textures beside the
/// file as STEM_LEVEL_colour.png (albedo and coverage) and STEM_LEVEL_normal.png. FBX has the character's
/// bones, and hangs roots and chains on them as glbOf() does. The same chain gives the same bytes. The names
/// of what is written beside it. Errors: no such level, a writer that is missing or fails, files that cannot
/// be written.
Result<std::vector<std::string>> writeCardMeshes(const cards::Chain& chain, CardMeshFormat format,
                                                 const std::filesystem::path& path,
                                                 const cards::Character& character = {},
                                                 cards::Cancel cancel = nullptr);

}  // namespace hairloom
