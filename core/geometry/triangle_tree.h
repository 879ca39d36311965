// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bounding boxes over triangles, for nearest points and rays. Grooming asks for the nearest point of a head a
// million times for each operator; CGAL's tree, which answers the same, takes ten times as long.

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
    /// Hits name triangles by their index in `triangles`.
    explicit TriangleTree(std::span<const Corners> triangles);

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

  private:
    /// A box with its two children, the first of which follows it; or with its triangles.
    struct alignas(16) Node {
        Eigen::Array4f low, high;  ///< the fourth is 0
        std::uint32_t next;        ///< the second child, or the first entry of `order_`
        std::uint32_t count;       ///< of triangles; 0 where there are children
    };
    void build(std::span<const Vec3f> centres, std::uint32_t first, std::uint32_t count);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;  ///< triangles as the leaves have them
    std::vector<Corners> corners_;      ///< in that order
};

}  // namespace hairloom
