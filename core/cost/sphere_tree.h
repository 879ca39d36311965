// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hierarchy of bubbles (Rünz 2012, Section 7.2, after Bradshaw and O'Sullivan): spheres around spheres, to
// find those that points of hair are in. The engine keeps lists of near spheres instead; `bench spheres`
// times both.

#include <cstdint>
#include <span>
#include <vector>

#include "hairloom/strands.h"

namespace hairloom {

/// A binary tree. Each node is a sphere around those of its children, a leaf one of the spheres. Split at the
/// middle of the centres along their longest extent, so that it has log₂ n levels whatever the spheres.
class SphereTree {
  public:
    /// Metres. Spheres without a radius above 0 are left out.
    explicit SphereTree(std::span<const runtime::Sphere> spheres);

    /// Adds the numbers of the spheres that are nearer than `margin` to the point, in no order.
    void find(runtime::Float3 point, float margin, std::vector<std::uint32_t>& found) const;
    std::size_t nodeCount() const { return nodes_.size(); }

  private:
    struct Node {
        runtime::Float3 centre;
        float radius;
        std::uint32_t skip;    ///< the node after this one's children
        std::uint32_t sphere;  ///< of a leaf
    };
    void build(std::span<std::uint32_t> some, std::span<const runtime::Sphere> spheres);

    std::vector<Node> nodes_;  ///< each before its children
};

}  // namespace hairloom
