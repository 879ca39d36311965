// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Choosing the part of a mesh that carries hair.

#include <span>
#include <string>
#include <string_view>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// Evaluates a selection as the command line takes it: `all`, `group:NAME`, `material:NAME`, `cap:DEGREES`
/// (faces whose normal leans at most that far from +Y), `above:F` (face centroids in the top 1−F of the
/// height of what is selected so far, F in [0, 1]), `faces:FILE` (one face of the source file per line, from
/// 0), `grow:N`, `shrink:N` (by edge-neighbours), `invert`, `connected` (the largest connected piece). A
/// comma means and, left to right. Errors name the term: unknown word, no such group (with the names there
/// are), a number out of range, an empty result.
Result<FaceSet> selectFaces(const ScalpMesh& mesh, std::string_view expression);

/// What can be said of a selection without a mesh. Errors: an unknown word, a number out of range.
Status checkSelection(std::string_view expression);

/// Faces of the groups named; a name that ends in * stands for all groups that begin with what precedes it.
/// Errors: no group of a name (with the names there are).
Result<FaceSet> facesOfGroups(const ScalpMesh& mesh, std::span<const std::string> names);

/// Of `faces` those that lie on another surface: their middle within five millimetres of it, facing as it
/// does. Error: none does, with how far away the nearest is.
Result<FaceSet> facesOnSurface(const ScalpMesh& mesh, const FaceSet& faces, const ScalpMesh& surface);

FaceSet growSelection(const ScalpMesh& mesh, const FaceSet& faces, int rings);
FaceSet shrinkSelection(const ScalpMesh& mesh, const FaceSet& faces, int rings);
FaceSet invertSelection(const ScalpMesh& mesh, const FaceSet& faces);
/// The edge-connected pieces of a selection, the largest by area first.
std::vector<FaceSet> connectedPieces(const ScalpMesh& mesh, const FaceSet& faces);

/// m²
double selectionArea(const ScalpMesh& mesh, const FaceSet& faces);

}  // namespace hairloom
