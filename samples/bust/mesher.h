// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the implicit surface to triangles: marching tetrahedra on one half, cut along the borders, remeshed to
// the wanted edge lengths with every vertex on the surface, mirrored.

#include <array>
#include <vector>

#include "samples/bust/head_shape.h"

namespace hairloom::bust {

struct PatchMesh {
    std::vector<Vec3d> positions;
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise from outside
    std::vector<Patch> patches;                 ///< one per triangle
};

/// The half with x >= 0, open in the plane x = 0, by marching tetrahedra with cells of `cell` metres; all of
/// it Patch::NeckFront.
PatchMesh marchHalf(double cell);

/// Cuts triangles along the borders and gives each its patch.
void cutIntoPatches(PatchMesh& half);

/// Splits, collapses, flips and smooths until edges have about edgeLength(); borders and the plane x = 0 stay
/// in place (Botsch and Kobbelt 2004, with a sizing field).
PatchMesh remeshHalf(const PatchMesh& half, int rounds);

/// Both halves; vertices in the plane x = 0 are shared.
PatchMesh mirror(const PatchMesh& half);

}  // namespace hairloom::bust
