// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The steps that turn a polygon soup into a manifold triangle mesh. Private to core/geometry.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// Triangles on their way to a ScalpMesh; every triangle remembers the corners of the soup it was cut from.
struct RepairedTriangles {
    std::vector<Vec3f> positions;               ///< per vertex
    std::vector<std::uint32_t> sourceVertices;  ///< per vertex, first soup vertex at this position
    std::vector<Triangle> triangles;            ///< vertex indices
    std::vector<Triangle> sourceCorners;        ///< per triangle, index into PolygonSoup::corners
    std::vector<std::uint32_t> sourceFaces;     ///< per triangle, face of the soup
    std::vector<MeshRepair> repairs;

    void note(const char* what, std::size_t count) {
        if (count > 0) repairs.push_back({what, count});
    }
};

/// Checks the soup and applies every repair but normals and UVs.
Result<RepairedTriangles> repairTriangles(const PolygonSoup& soup);

/// Turns faces so that neighbours agree, then parts what touches along an edge of more than two faces, or at
/// a vertex only, by giving each side vertices of its own.
void makeManifold(RepairedTriangles& mesh);

/// Cuts a polygon of points.size() ≥ 3 into points.size() − 2 triangles of indices into `points`, keeping its
/// winding. Concave and slightly bent polygons are cut inside their outline, projected along the mean normal.
/// Outlines that cross themselves are fanned from the first corner; `crossing` tells.
std::vector<Triangle> triangulatePolygon(std::span<const Vec3f> points, bool& crossing);

/// True when the corners are on one line, to the precision of double arithmetic on float coordinates.
bool isDegenerate(const Vec3f& a, const Vec3f& b, const Vec3f& c);

}  // namespace hairloom
