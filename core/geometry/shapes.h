// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes made from numbers, which tests and benchmarks share.

#include <cstdlib>
#include <functional>
#include <initializer_list>

#include "core/geometry/scalp_mesh.h"

namespace hairloom::shapes {

inline void addFace(PolygonSoup& soup, std::initializer_list<std::uint32_t> corners) {
    soup.corners.insert(soup.corners.end(), corners);
    soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
}

/// The mesh of a soup that is known to be good; ends the program where it is not.
ScalpMesh meshOf(const PolygonSoup& soup);

/// A square of `cells`² quads in the plane y = 0, normal +Y, `size` metres a side, centred on the origin.
/// Faces for which `keep(column, row)` is false are left out. Its UVs are x and z over the size.
PolygonSoup grid(std::uint32_t cells, float size,
                 const std::function<bool(std::uint32_t, std::uint32_t)>& keep = {});

/// A sphere around the origin made of 20·4^subdivisions triangles.
PolygonSoup icosphere(int subdivisions, float radius);

}  // namespace hairloom::shapes
