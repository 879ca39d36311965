// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/geometry/mesh_repair.h"

namespace hairloom {
namespace {

/// Side `corner` of a triangle runs from its corner to the next one; corners are numbered 3·triangle + i.
struct Side {
    std::uint32_t low, high;  ///< vertices
    std::uint32_t corner;
    auto operator<=>(const Side&) const = default;
};

constexpr std::uint32_t nextCorner(std::uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// All sides, those of one edge next to each other.
std::vector<Side> sortedSides(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(triangles.size() * 3);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
            sides.push_back({low, high, 3 * t + i});
        }
    std::sort(sides.begin(), sides.end());
    return sides;
}

/// Calls visit(first, last) for the sides of each edge.
template <class Visit>
void forEachEdge(const std::vector<Side>& sides, Visit visit) {
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t last = first + 1;
        while (last < sides.size() && sides[last].low == sides[first].low &&
               sides[last].high == sides[first].high)
            ++last;
        visit(first, last);
        first = last;
    }
}

bool runsAlike(const std::vector<Triangle>& triangles, std::uint32_t a, std::uint32_t b) {
    return triangles[a / 3][a % 3] == triangles[b / 3][b % 3];
}

struct Neighbour {
    std::uint32_t triangle;
    bool alike;  ///< both run along the shared edge in the same direction, so one of them is turned over
};

/// Per corner, the triangle across the side, for edges of exactly two faces.
std::vector<Neighbour> neighboursOf(const std::vector<Triangle>& triangles) {
    constexpr Neighbour kOpen{~0u, false};
    std::vector<Neighbour> neighbours(triangles.size() * 3, kOpen);
    const std::vector<Side> sides = sortedSides(triangles);
    forEachEdge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first != 2) return;
        const std::uint32_t a = sides[first].corner, b = sides[first + 1].corner;
        const bool alike = runsAlike(triangles, a, b);
        neighbours[a] = {b / 3, alike};
        neighbours[b] = {a / 3, alike};
    });
    return neighbours;
}

/// Turns the smaller part of each piece over where neighbours disagree. Pieces with one side only (Möbius
/// bands) keep a disagreement, which separateSides parts.
void orientFaces(RepairedTriangles& mesh) {
    const std::vector<Neighbour> neighbours = neighboursOf(mesh.triangles);
    std::vector<signed char> turned(mesh.triangles.size(), -1);
    std::vector<std::uint32_t> piece;
    std::size_t turns = 0;
    for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (turned[seed] != -1) continue;
        piece.assign(1, seed);
        turned[seed] = 0;
        std::size_t ones = 0;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::uint32_t t = piece[i];
            ones += turned[t] == 1;
            for (std::uint32_t side = 0; side < 3; ++side) {
                const Neighbour& neighbour = neighbours[3 * t + side];
                if (neighbour.triangle == ~0u || turned[neighbour.triangle] != -1) continue;
                const bool turn = (turned[t] == 1) != neighbour.alike;
                turned[neighbour.triangle] = turn ? 1 : 0;
                piece.push_back(neighbour.triangle);
            }
        }
        const signed char toTurn = 2 * ones > piece.size() ? 0 : 1;
        for (const std::uint32_t t : piece) {
            if (turned[t] != toTurn) continue;
            std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
            std::swap(mesh.sourceCorners[t][1], mesh.sourceCorners[t][2]);
            ++turns;
        }
    }
    mesh.note("faces turned to agree with their neighbours", turns);
}

/// Union-find over corners: the corners of one set become one vertex.
class CornerSets {
  public:
    explicit CornerSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t corner) {
        while (parent_[corner] != corner) {
            parent_[corner] = parent_[parent_[corner]];
            corner = parent_[corner];
        }
        return corner;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t rootA = find(a), rootB = find(b);
        parent_[std::max(rootA, rootB)] = std::min(rootA, rootB);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// Corners joined over every edge that has two agreeing faces, neither of them detached: each set is one fan.
std::vector<Triangle> fanVertices(const std::vector<Triangle>& triangles, const std::vector<Side>& sides,
                                  const std::vector<bool>& detached, std::size_t& openedEdges) {
    CornerSets sets(triangles.size() * 3);
    openedEdges = 0;
    forEachEdge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first == 1) return;
        const std::uint32_t a = sides[first].corner, b = sides[first + 1].corner;
        if (last - first > 2 || runsAlike(triangles, a, b) || detached[a / 3] || detached[b / 3]) {
            ++openedEdges;
            return;
        }
        sets.join(a, nextCorner(b));
        sets.join(nextCorner(a), b);
    });
    std::vector<Triangle> labels(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i) labels[t][i] = sets.find(3 * t + i);
    return labels;
}

/// Detaches every face but the first of an edge that is still no manifold edge when vertices are `labels`.
/// Fans that meet again on both ends of an opened edge leave such edges.
bool detachOffenders(const std::vector<Triangle>& labels, std::vector<bool>& detached) {
    bool any = false;
    const std::vector<Side> sides = sortedSides(labels);
    forEachEdge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first == 1) return;
        if (last - first == 2 && !runsAlike(labels, sides[first].corner, sides[first + 1].corner)) return;
        for (std::size_t i = first + 1; i < last; ++i) detached[sides[i].corner / 3] = true;
        any = true;
    });
    return any;
}

/// Numbers the fans by the vertex they come from, then by their first corner, and copies positions.
void renumber(RepairedTriangles& mesh, const std::vector<Triangle>& labels) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fans;  // (vertex, label)
    for (std::uint32_t t = 0; t < labels.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i)
            if (labels[t][i] == 3 * t + i) fans.emplace_back(mesh.triangles[t][i], labels[t][i]);
    std::sort(fans.begin(), fans.end());
    std::vector<std::uint32_t> vertexOf(labels.size() * 3, 0);
    std::vector<Vec3f> positions;
    std::vector<std::uint32_t> sources;
    std::size_t distinct = 0;
    for (std::size_t i = 0; i < fans.size(); ++i) {
        const auto [vertex, label] = fans[i];
        distinct += i == 0 || fans[i - 1].first != vertex;
        vertexOf[label] = static_cast<std::uint32_t>(i);
        positions.push_back(mesh.positions[vertex]);
        sources.push_back(mesh.sourceVertices[vertex]);
    }
    for (std::size_t t = 0; t < labels.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) mesh.triangles[t][i] = vertexOf[labels[t][i]];
    mesh.note("vertices of degenerate faces dropped", mesh.positions.size() - distinct);
    mesh.note("vertices split where parts only touch", fans.size() - distinct);
    mesh.positions = std::move(positions);
    mesh.sourceVertices = std::move(sources);
}

}  // namespace

void makeManifold(RepairedTriangles& mesh) {
    orientFaces(mesh);
    const std::vector<Side> sides = sortedSides(mesh.triangles);
    std::vector<bool> detached(mesh.triangles.size(), false);
    std::size_t openedEdges = 0;
    std::vector<Triangle> labels = fanVertices(mesh.triangles, sides, detached, openedEdges);
    const std::size_t nonManifoldEdges = openedEdges;
    while (detachOffenders(labels, detached))
        labels = fanVertices(mesh.triangles, sides, detached, openedEdges);
    mesh.note("edges with more than two faces, or faces that disagree, opened", nonManifoldEdges);
    renumber(mesh, labels);
}

}  // namespace hairloom
