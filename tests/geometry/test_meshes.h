// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Small meshes made in code, and random points, for the tests of any room.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <iostream>
#include <map>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/scalp_mesh.h"

namespace hairloom::test {

/// In a cube around the origin, half of whose side is `extent`.
inline Vec3f randomPoint(Random& random, float extent) {
    return {random.uniform(-extent, extent), random.uniform(-extent, extent),
            random.uniform(-extent, extent)};
}

inline void addFace(PolygonSoup& soup, std::initializer_list<std::uint32_t> corners) {
    soup.corners.insert(soup.corners.end(), corners);
    soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
}

/// The mesh of a soup that a test knows to be good.
inline ScalpMesh meshOf(const PolygonSoup& soup) {
    Result<ScalpMesh> mesh = ScalpMesh::make(soup);
    if (!mesh) {
        std::cerr << mesh.error().message() << '\n';
        std::abort();
    }
    return std::move(*mesh);
}

/// A square of `cells`² quads in the plane y = 0, normal +Y, `size` metres a side, centred on the origin.
/// Faces for which `keep(column, row)` is false are left out. Its UVs are x and z over the size.
inline PolygonSoup gridSoup(std::uint32_t cells, float size,
                            const std::function<bool(std::uint32_t, std::uint32_t)>& keep = {}) {
    PolygonSoup soup;
    const float step = size / static_cast<float>(cells);
    for (std::uint32_t row = 0; row <= cells; ++row)
        for (std::uint32_t column = 0; column <= cells; ++column)
            soup.positions.emplace_back(static_cast<float>(column) * step - size / 2, 0,
                                        static_cast<float>(row) * step - size / 2);
    for (std::uint32_t row = 0; row < cells; ++row)
        for (std::uint32_t column = 0; column < cells; ++column) {
            if (keep && !keep(column, row)) continue;
            const std::uint32_t first = row * (cells + 1) + column;
            addFace(soup, {first, first + cells + 1, first + cells + 2, first + 1});
        }
    for (const std::uint32_t corner : soup.corners) {
        const Vec3f& p = soup.positions[corner];
        soup.uvs.emplace_back(p.x() / size + 0.5f, 0.5f - p.z() / size);
    }
    return soup;
}

/// A sphere around the origin made of 20·4^subdivisions triangles.
inline PolygonSoup icosphereSoup(int subdivisions, float radius) {
    const float g = (1 + std::sqrt(5.0f)) / 2;
    std::vector<Vec3f> points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<Triangle> triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, fresh] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (fresh) points.push_back((points[a].normalized() + points[b].normalized()) / 2);
            return place->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    PolygonSoup soup;
    for (const Vec3f& point : points) soup.positions.push_back(point.normalized() * radius);
    for (const auto& [a, b, c] : triangles) addFace(soup, {a, b, c});
    return soup;
}

/// A torus around the Y axis of `around` × `across` quads.
inline PolygonSoup torusSoup(std::uint32_t around, std::uint32_t across, float major, float minor) {
    PolygonSoup soup;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const float u = 2 * kPi * static_cast<float>(i) / static_cast<float>(around);
            const float v = 2 * kPi * static_cast<float>(j) / static_cast<float>(across);
            const float r = major + minor * std::cos(v);
            soup.positions.emplace_back(r * std::cos(u), minor * std::sin(v), r * std::sin(u));
        }
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
            addFace(soup, {i * across + j, i * across + j1, i1 * across + j1, i1 * across + j});
        }
    return soup;
}

/// A flat ring around the Y axis, normal +Y, of `around` quads; `gap` of them are missing.
inline PolygonSoup ringSoup(std::uint32_t around, float inner, float outer, std::uint32_t gap = 0) {
    PolygonSoup soup;
    for (std::uint32_t i = 0; i < around; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(around);
        for (const float r : {inner, outer})
            soup.positions.emplace_back(r * std::cos(angle), 0, r * std::sin(angle));
    }
    for (std::uint32_t i = gap; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        addFace(soup, {2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
    }
    return soup;
}

/// Adds all faces of `part`, moved by `offset`; UVs and normals are dropped.
inline void append(PolygonSoup& soup, const PolygonSoup& part, const Vec3f& offset) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    const auto corners = static_cast<std::uint32_t>(soup.corners.size());
    for (const Vec3f& position : part.positions) soup.positions.push_back(position + offset);
    for (const std::uint32_t corner : part.corners) soup.corners.push_back(first + corner);
    for (std::size_t f = 1; f < part.offsets.size(); ++f) soup.offsets.push_back(corners + part.offsets[f]);
    soup.uvs.clear();
    soup.normals.clear();
}

inline FaceSet allFaces(const ScalpMesh& mesh) {
    FaceSet faces(mesh.triangleCount());
    for (std::uint32_t t = 0; t < faces.size(); ++t) faces[t] = t;
    return faces;
}

}  // namespace hairloom::test
