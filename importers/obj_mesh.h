// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Polygons of Wavefront OBJ files. Read here rather than through assimp 5.2.5, which keeps neither the order
// of the faces nor groups that are taken up again, tells no line, and shares no vertices.

#include <filesystem>
#include <string>

#include "importers/raw_scene.h"

namespace hairloom {

/// `text` is the file's content. Reads v, vt, vn, f, g, o, usemtl and mtllib (of which only the name is
/// looked at); other lines are passed over. A face's group is the last g line's text, or the last o line's
/// where no g line follows it; before either it is "default". Faces stand in the file's order, and positions
/// in the file's order. Errors, with the line: a malformed or non-finite number, an index that names nothing;
/// a file without faces.
Result<RawScene> readObjMesh(const std::filesystem::path& path, const std::string& text);

}  // namespace hairloom
