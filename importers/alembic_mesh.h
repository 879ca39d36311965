// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes of Alembic files: polygons and subdivision surfaces, all that are visible, as one head.

#include <span>
#include <string>

#include "importers/raw_scene.h"

namespace hairloom {

/// `bytes` is the whole file. Polygons of subdivision surfaces are those of their cage. Sets of faces are
/// groups, others have the name of their object. Transforms that change are a bone and a clip. Points that
/// move play in it, too. Errors: no Ogawa, damage, no visible mesh that can be read.
Result<RawScene> readAlembicMesh(const std::string& file, std::span<const std::byte> bytes);

}  // namespace hairloom
