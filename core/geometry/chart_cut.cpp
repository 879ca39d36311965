// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include "core/geometry/flat_chart.h"

namespace hairloom {
namespace {

constexpr std::uint32_t nextSide(std::uint32_t side) {
    return side % 3 == 2 ? side - 2 : side + 1;
}

class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t item) {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

  private:
    std::vector<std::uint32_t> parent_;
};

/// Per corner, the vertex of the piece when sides are glued where `glued` says so; returns the number of
/// vertices.
std::vector<std::uint32_t> cornerVertices(std::span<const std::uint32_t> opposite,
                                          const std::vector<bool>& glued, std::uint32_t& count) {
    Sets sets(opposite.size());
    for (std::uint32_t side = 0; side < opposite.size(); ++side) {
        if (opposite[side] == kOpenSide || !glued[side]) continue;
        sets.join(side, nextSide(opposite[side]));
        sets.join(nextSide(side), opposite[side]);
    }
    std::vector<std::uint32_t> number(opposite.size(), ~0u), vertexOf(opposite.size());
    count = 0;
    for (std::uint32_t corner = 0; corner < opposite.size(); ++corner) {
        std::uint32_t& label = number[sets.find(corner)];
        if (label == ~0u) label = count++;
        vertexOf[corner] = label;
    }
    return vertexOf;
}

/// Glues faces along a breadth-first tree, which gives a disc.
std::vector<bool> glueTree(std::span<const std::uint32_t> opposite) {
    std::vector<bool> glued(opposite.size(), false), reached(opposite.size() / 3, false);
    std::vector<std::uint32_t> queue{0};
    reached[0] = true;
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (std::uint32_t side = 3 * queue[i]; side < 3 * queue[i] + 3; ++side) {
            const std::uint32_t across = opposite[side];
            if (across == kOpenSide || reached[across / 3]) continue;
            reached[across / 3] = true;
            glued[side] = glued[across] = true;
            queue.push_back(across / 3);
        }
    return glued;
}

/// Glues cuts that end inside the surface, from their loose ends on: the piece stays a disc. False when
/// nothing of the cut is left, which closes the surface.
bool glueLooseEnds(std::span<const std::uint32_t> opposite, std::vector<bool>& glued) {
    std::uint32_t count = 0;
    const std::vector<bool> all(opposite.size(), true);
    const std::vector<std::uint32_t> vertexOf = cornerVertices(opposite, all, count);
    std::vector<std::vector<std::uint32_t>> cutsAt(count);  // unglued sides, one for each edge
    for (std::uint32_t side = 0; side < opposite.size(); ++side) {
        const bool counted = opposite[side] == kOpenSide || side < opposite[side];
        if (glued[side] || !counted) continue;
        cutsAt[vertexOf[side]].push_back(side);
        cutsAt[vertexOf[nextSide(side)]].push_back(side);
    }
    std::vector<std::uint32_t> degree(count), loose;
    std::size_t cuts = 0;
    for (std::uint32_t v = 0; v < count; ++v) {
        degree[v] = static_cast<std::uint32_t>(cutsAt[v].size());
        cuts += degree[v];
        if (degree[v] == 1) loose.push_back(v);
    }
    cuts /= 2;
    while (!loose.empty()) {
        const std::uint32_t v = loose.back();
        loose.pop_back();
        for (const std::uint32_t side : cutsAt[v]) {
            if (glued[side] || opposite[side] == kOpenSide) continue;
            glued[side] = glued[opposite[side]] = true;
            --cuts;
            for (const std::uint32_t end : {vertexOf[side], vertexOf[nextSide(side)]})
                if (--degree[end] == 1) loose.push_back(end);
        }
    }
    return cuts > 0;
}

/// The face that a breadth-first walk from `start` reaches last.
std::uint32_t farthestFace(std::span<const std::uint32_t> opposite, std::uint32_t start) {
    std::vector<bool> reached(opposite.size() / 3, false);
    std::vector<std::uint32_t> queue{start};
    reached[start] = true;
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (std::uint32_t side = 3 * queue[i]; side < 3 * queue[i] + 3; ++side) {
            if (opposite[side] == kOpenSide || reached[opposite[side] / 3]) continue;
            reached[opposite[side] / 3] = true;
            queue.push_back(opposite[side] / 3);
        }
    return queue.back();
}

}  // namespace

std::vector<std::uint32_t> oppositeSides(const ScalpMesh& mesh, const FaceSet& faces) {
    const ScalpMesh::Connectivity& connectivity = mesh.connectivity();
    std::vector<std::uint32_t> opposite(faces.size() * 3, kOpenSide);
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const Triangle& t = mesh.triangles()[faces[f]];
        for (std::uint32_t i = 0; i < 3; ++i) {
            const auto from = OpenMesh::VertexHandle(static_cast<int>(t[i]));
            const auto to = OpenMesh::VertexHandle(static_cast<int>(t[(i + 1) % 3]));
            const auto across = connectivity.opposite_face_handle(connectivity.find_halfedge(from, to));
            if (!across.is_valid()) continue;
            const auto face = static_cast<std::uint32_t>(across.idx());
            const auto place = std::lower_bound(faces.begin(), faces.end(), face);
            if (place == faces.end() || *place != face) continue;
            const Triangle& other = mesh.triangles()[face];
            const std::uint32_t corner = other[0] == t[(i + 1) % 3] ? 0 : other[1] == t[(i + 1) % 3] ? 1 : 2;
            opposite[3 * f + i] = 3 * static_cast<std::uint32_t>(place - faces.begin()) + corner;
        }
    }
    return opposite;
}

std::optional<ChartPiece> cutToDisc(const ScalpMesh& mesh, const FaceSet& faces) {
    const std::vector<std::uint32_t> opposite = oppositeSides(mesh, faces);
    std::vector<bool> glued = glueTree(opposite);
    if (!glueLooseEnds(opposite, glued)) return std::nullopt;
    ChartPiece piece;
    piece.faces = faces;
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> vertexOf = cornerVertices(opposite, glued, count);
    piece.positions.resize(count);
    piece.triangles.resize(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            piece.triangles[f][i] = vertexOf[3 * f + i];
            piece.positions[vertexOf[3 * f + i]] =
                mesh.positions()[mesh.triangles()[faces[f]][i]].cast<double>();
        }
    return piece;
}

std::pair<FaceSet, FaceSet> splitFaces(const ScalpMesh& mesh, const FaceSet& faces) {
    const std::vector<std::uint32_t> opposite = oppositeSides(mesh, faces);
    const std::uint32_t first = farthestFace(opposite, 0);
    const std::uint32_t second = farthestFace(opposite, first);
    std::vector<signed char> side(faces.size(), -1);
    std::vector<std::uint32_t> queue{first, second};
    side[first] = 0;
    side[second] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (std::uint32_t s = 3 * queue[i]; s < 3 * queue[i] + 3; ++s) {
            if (opposite[s] == kOpenSide || side[opposite[s] / 3] != -1) continue;
            side[opposite[s] / 3] = side[queue[i]];
            queue.push_back(opposite[s] / 3);
        }
    std::pair<FaceSet, FaceSet> parts;
    for (std::size_t f = 0; f < faces.size(); ++f)
        (side[f] == 0 ? parts.first : parts.second).push_back(faces[f]);
    return parts;
}

}  // namespace hairloom
