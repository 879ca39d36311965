// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Small meshes made in code, and random points, for the tests of any room.

#include <cmath>
#include <cstdint>
#include <functional>

#include "core/base/random.h"
#include "core/geometry/shapes.h"

namespace hairloom::test {

/// In a cube around the origin, half of whose side is `extent`.
inline Vec3f randomPoint(Random& random, float extent) {
    return {random.uniform(-extent, extent), random.uniform(-extent, extent),
            random.uniform(-extent, extent)};
}

using shapes::addFace;
using shapes::meshOf;

/// As shapes::grid and shapes::icosphere.
inline PolygonSoup gridSoup(std::uint32_t cells, float size,
                            const std::function<bool(std::uint32_t, std::uint32_t)>& keep = {}) {
    return shapes::grid(cells, size, keep);
}
inline PolygonSoup icosphereSoup(int subdivisions, float radius) {
    return shapes::icosphere(subdivisions, radius);
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
