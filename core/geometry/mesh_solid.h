// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a mesh encloses, whatever mesh it is: closed, open at the neck, of many parts one in another.

#include <atomic>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/scalp_mesh.h"
#include "core/geometry/triangle_tree.h"

namespace hairloom {

/// Inside is where triangles go around a point by more than half (TriangleTree::windingNumber()), in either
/// sense, so that parts may be mirrored; how far is told by the nearest point. Queries run on any number of
/// threads at once.
class MeshSolid {
  public:
    /// Keeps a copy of what it needs. Triangles name positions, which are finite.
    MeshSolid(std::span<const Vec3f> positions, std::span<const Triangle> triangles);

    bool contains(const Vec3f& point) const;
    /// To the nearest triangle, metres, ≥ 0; infinite without triangles.
    float distance(const Vec3f& point) const;
    /// The same, negative inside.
    float signedDistance(const Vec3f& point) const {
        return contains(point) ? -distance(point) : distance(point);
    }
    const Box3f& bounds() const { return bounds_; }
    const TriangleTree& tree() const { return tree_; }
    /// Those of the triangles that it was made from between inside and outside: all but those of parts that
    /// lie in another.
    std::vector<std::uint32_t> skin() const;
    /// Whether anything is inside: tried behind triangles from everywhere. A sheet encloses
    /// nothing.
    bool enclosesAnything() const;

  private:
    /// Before and behind its middle.
    std::pair<Vec3f, Vec3f> besideTriangle(std::size_t triangle, float depth) const;

    Box3f bounds_;
    std::vector<TriangleTree::Corners> corners_;
    TriangleTree tree_;
};

/// Signed distances at the middles of cells, measured when they are first asked for: what spares most of many
/// queries a search. Answers do not depend on who asks first. The solid outlives it.
class SolidGrid {
  public:
    static constexpr float kCell = 0.004f;  ///< metres; larger for solids of more than kMostCells of these
    static constexpr double kMostCells = 4e6;

    explicit SolidGrid(const MeshSolid& solid);

    struct Bound {
        float distance;  ///< signed, at the middle of the cell; infinite outside the solid's bounds
        float away;      ///< metres from there to the point: by so much the point's own may differ
    };
    Bound at(const Vec3f& point) const;
    const MeshSolid& solid() const { return solid_; }

  private:
    const MeshSolid& solid_;
    float cell_;
    Eigen::Array3i size_ = Eigen::Array3i::Zero();
    Vec3f low_ = Vec3f::Zero();
    std::unique_ptr<std::atomic<float>[]> middles_;  ///< NaN until measured
};

}  // namespace hairloom
