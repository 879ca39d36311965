// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whole strands that come and go, with all their attributes.

#include <span>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom::editing {

/// Strands outside a groom, and where in it they belong.
struct TakenStrands {
    std::vector<std::uint32_t> indices;  ///< ascending; of the strands in a groom that holds them
    std::vector<std::uint32_t> counts;   ///< points of each
    AttributeSet strandData;             ///< of the same names and types as the groom's
    AttributeSet pointData;
    std::size_t bytes() const;
};

/// Removes strands (ascending indices, without repeats) and gives them. The triangulation is left as it is.
TakenStrands takeOut(Groom& groom, std::span<const std::uint32_t> strands);
/// The inverse. Attributes that the strands have and the groom does not are dropped, but where the groom has
/// no strands; those that the groom has and the strands do not become zero.
void putBack(Groom& groom, const TakenStrands& strands);

/// Strands that differ between two states of a groom: there in one, not in the other. A triangulation names
/// strands by index, so it belongs to a state: the other's is kept here, and a new state begins without.
class StrandDelta {
  public:
    /// Removes them from the groom now.
    void remove(Groom& groom, std::span<const std::uint32_t> strands);
    /// Puts them into the groom now; `strands.indices` are those that they will have. More may follow behind.
    void insert(Groom& groom, const TakenStrands& strands);

    void exchange(Groom& groom);
    bool empty() const { return indices_.empty(); }
    std::size_t count() const { return indices_.size(); }
    std::size_t bytes() const;

  private:
    std::vector<std::uint32_t> indices_;
    TakenStrands away_;  ///< empty while the strands are in the groom
    bool present_ = true;
    RootTriangulation triangulation_;  ///< of the other state
    bool fromNothing_ = false;         ///< without these strands the groom has none
    AttributeSet noStrands_;           ///< attributes of such a groom
    AttributeSet noPoints_;
};

}  // namespace hairloom::editing
