// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bounding boxes over triangles, for nearest points, rays and what triangles enclose. Grooming asks for the
// nearest point of a head a million times for each operator; CGAL's tree, which answers the same, takes ten
// times as long.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace hairloom {

class TriangleTree {
  public:
    struct Corners {
        Vec3f a, b, c;
    };
    enum class Winding : bool { no, yes };
    /// Hits name triangles by their index in `triangles`. Winding numbers take a third more memory.
    explicit TriangleTree(std::span<const Corners> triangles, Winding winding = Winding::no);

    struct Hit {
        std::uint32_t triangle;
        Vec3d barycentric;  ///< each in [0, 1], sum 1
        Vec3d position;
        double distance;  ///< from the point, or along the ray in lengths of its direction
    };
    /// Nothing without triangles, and for a point that is not finite. Of triangles at the same distance the
    /// one with the least index.
    std::optional<Hit> closest(const Vec3f& point) const;
    /// The first triangle, from either side, that the ray meets at or behind its origin. `direction` is
    /// finite and not zero.
    std::optional<Hit> firstHit(const Vec3f& origin, const Vec3f& direction) const;

    /// How often the triangles go around the point, counter-clockwise from outside (the generalised winding
    /// number of Jacobson et al. 2013, summed as Barill et al. 2018 do): 1 in a closed mesh, 2 where two
    /// overlap, something between where one is open. Within a hundredth of the exact sum. 0 without triangles
    /// and for a point that is not finite. Only of a tree that was made with Winding::yes.
    double windingNumber(const Vec3f& point) const;

  private:
    /// A box with its two children, the first of which follows it; or with its triangles.
    struct alignas(16) Node {
        Eigen::Array4f low, high;  ///< the fourth is 0
        std::uint32_t next;        ///< the second child, or the first entry of `order_`
        std::uint32_t count;       ///< of triangles; 0 where there are children
    };
    /// What the triangles of a node are from afar.
    struct Dipole {
        Vec3d centre, normal;  ///< their mean by area, and the sum of their normals as long as their areas
        double radius;         ///< metres around the centre, which holds all of them
        double area;
    };
    void build(std::span<const Vec3f> centres, std::uint32_t first, std::uint32_t count);
    void sumDipoles();

    std::vector<Node> nodes_;
    std::vector<Dipole> dipoles_;       ///< of each node, or none
    std::vector<std::uint32_t> order_;  ///< triangles as the leaves have them
    std::vector<Corners> corners_;      ///< in that order
};

}  // namespace hairloom
