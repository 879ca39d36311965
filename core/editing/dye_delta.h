// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The painted mask of the dye where it differs, to be exchanged with the groom's.

#include <span>
#include <vector>

#include "core/editing/strand_values.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

/// The point attribute `dye` of touched strands. Where a groom has none it is made of what the hair shows
/// (pointDyes()), and gone again on the other side. While it gathers, strands keep their indices and numbers
/// of points.
class DyeDelta {
  public:
    /// Keeps the values of the strands (ascending) that are not kept yet, makes the mask where there is none,
    /// and turns the material's dye on where it has no strength, for nobody would see the mask.
    void keep(Groom& groom, std::span<const std::uint32_t> strands);
    /// No more keep(): sorts by strand, drops those whose values are as they were. Where none is left, groom
    /// and material are as they were before the first.
    void finish(Groom& groom);

    void exchange(Groom& groom);
    bool empty() const { return mask_.empty(); }
    /// The material's strength of the dye is another on the other side.
    bool changesStrength() const { return turnsOn_; }
    std::span<const std::uint32_t> strands() const { return mask_.strands(); }  ///< ascending after finish()
    std::size_t bytes() const { return mask_.heapBytes(); }

  private:
    StrandValues<float> mask_;
    bool absent_ = false;  ///< the groom on the other side has no such mask
    bool turnsOn_ = false;
    float strength_ = 0;  ///< of the material's dye on the other side, where it was turned on
};

}  // namespace hairloom::editing
