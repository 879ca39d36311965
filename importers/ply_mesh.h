// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Polygons of PLY files (Turk 1994): text and binary of both byte orders. Read here because assimp 5.2.5
// never returns on many damaged headers.

#include <span>

#include "importers/ply_header.h"
#include "importers/raw_scene.h"

namespace hairloom {

/// `bytes` is the whole file. Reads x, y, z, nx, ny, nz, and u, v (also s, t, texture_u, texture_v) of
/// vertices, vertex_indices (also vertex_index) and texcoord of faces; passes over everything else. Faces and
/// positions stand in the file's order. Errors, with the line of the header or of a text body, or with the
/// byte of a binary body.
Result<RawScene> readPlyMesh(const std::string& file, std::span<const std::byte> bytes);

}  // namespace hairloom
