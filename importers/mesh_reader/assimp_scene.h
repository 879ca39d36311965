// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "importers/mesh_format.h"
#include "importers/raw_scene.h"

namespace hairloom {

/// The scene of an STL or FBX file, of glTF or GLB of version 1, or assimp's reason why not. May throw, crash
/// or never return on damaged files; nothing of the result is validated.
Result<RawScene> readWithAssimp(const char* file, MeshFormat format);

}  // namespace hairloom
