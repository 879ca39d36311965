// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes of USD files: all that the stage shows, as one head, with what moves them.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "importers/raw_scene.h"

namespace hairloom {

/// `bytes` are the whole file, which may be text, binary or a package; other files of the stage lie in
/// `folder`. Polygons of subdivision surfaces are those of their cage. Subsets of faces are groups, others
/// have the name of their mesh. Errors: no USD, damage in the file itself, no mesh that shows or that can be
/// read.
Result<RawScene> readUsdMesh(const std::string& file, std::vector<std::byte>&& bytes,
                             const std::filesystem::path& folder);

}  // namespace hairloom
