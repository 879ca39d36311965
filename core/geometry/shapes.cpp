// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/shapes.h"

#include <cmath>
#include <iostream>
#include <map>
#include <utility>

namespace hairloom::shapes {

ScalpMesh meshOf(const PolygonSoup& soup) {
    Result<ScalpMesh> mesh = ScalpMesh::make(soup);
    if (!mesh) {
        std::cerr << mesh.error().message() << '\n';
        std::abort();
    }
    return std::move(*mesh);
}

PolygonSoup grid(std::uint32_t cells, float size,
                 const std::function<bool(std::uint32_t, std::uint32_t)>& keep) {
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

PolygonSoup icosphere(int subdivisions, float radius) {
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

}  // namespace hairloom::shapes
