// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where some strands are rooted, to be exchanged with where those of the groom are.

#include <cstdint>
#include <span>
#include <vector>

#include "core/editing/strand_values.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

/// Bindings and root UVs of strands that move on the scalp, the points of their base shapes where there are
/// operators, and the triangulation, which belongs to the places of the roots. While it gathers, strands keep
/// their indices and numbers of points. For grooms whose strands are bound.
class RootDelta {
  public:
    /// Keeps what the strands (ascending) have that are not kept yet, and empties the triangulation.
    void keep(Groom& groom, std::span<const std::uint32_t> strands);
    /// As it was when kept, of a strand that is.
    const SurfacePoint& kept(std::uint32_t strand) const;
    /// The base shape as it was when kept; empty where there are no operators.
    std::span<const Vec3f> keptBase(std::uint32_t strand) const { return base_.kept(strand); }
    /// No more keep() or kept(). Where all roots are as they were, the groom is as it was before the first.
    void finish(Groom& groom);

    void exchange(Groom& groom);
    bool empty() const { return strands_.empty() && base_.empty(); }
    std::span<const std::uint32_t> strands() const { return strands_; }  ///< ascending; whose roots moved
    std::size_t bytes() const;

  private:
    struct Root {
        SurfacePoint place;
        Vec2f uv = Vec2f::Zero();
    };
    static Root rootOf(const Groom& groom, std::uint32_t strand);

    std::vector<std::uint32_t> strands_;
    std::vector<Root> roots_;
    StrandValues<Vec3f> base_;
    RootTriangulation triangulation_;  ///< of the other side
};

}  // namespace hairloom::editing
