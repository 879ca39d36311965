// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards and shells as USD.

#include <filesystem>
#include <string>
#include <vector>

#include "core/cards/levels.h"

namespace hairloom {

/// What of the chain is no strands as USD's text, metres, Y up: a mesh for each level, each a variant of the
/// set "lod" (the nearest LOD0), with a UsdPreviewSurface whose textures go beside the file, as
/// writeCardMeshes() has them. The same chain gives the same bytes. The names of what is written beside it.
/// Errors: no such level, files that cannot be written.
Result<std::vector<std::string>> writeCardUsd(const cards::Chain& chain, const std::filesystem::path& path);

}  // namespace hairloom
