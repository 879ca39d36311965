// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "importers/raw_scene.h"

namespace hairloom {

/// The scene of a glTF 2.0 file (.gltf or .glb): triangles with morph targets at their weights of rest,
/// bones, clips. Errors: what is damaged, what the file requires and is not read; version 1 is assimp's.
/// `file` is the path of `bytes`.
Result<RawScene> readGltf(const char* file, std::span<const std::byte> bytes);

}  // namespace hairloom
