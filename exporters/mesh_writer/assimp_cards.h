// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards as files of meshes, by assimp.

#include <vector>

#include "core/base/result.h"
#include "exporters/card_mesh_scene.h"

namespace hairloom {

/// The same scene gives the same bytes. Errors: assimp's reason.
Result<std::vector<WrittenMeshFile>> meshFilesOf(const CardMeshScene& scene);

}  // namespace hairloom
