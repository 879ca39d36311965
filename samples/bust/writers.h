// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The bust as text and binary files. Equal input gives equal bytes.

#include <string>
#include <vector>

#include "samples/bust/unwrap.h"

namespace hairloom::bust {

/// Wavefront OBJ: welded vertices, texture coordinates, a `g` and a `usemtl` for each group. Lengths rounded
/// to 1e-5 m.
std::string objText(const PatchMesh& welded, const UnwrappedMesh& mesh);
/// The materials that objText names.
std::string mtlText();

/// glTF 2.0 binary: a node, mesh and material for each group, skinned to the bones, with the clip.
std::vector<std::byte> glbBytes(const UnwrappedMesh& mesh);

/// Linear colour of a group's material.
Vec3d groupColour(Group group);

}  // namespace hairloom::bust
