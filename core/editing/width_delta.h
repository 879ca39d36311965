// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Painted widths where they differ, to be exchanged with the groom's.

#include <cstdint>
#include <span>

#include "core/editing/strand_values.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

/// The point attribute `width_change` of touched strands. While it gathers, strands keep their indices and
/// numbers of points.
class WidthDelta {
  public:
    /// Keeps the values of the strands (ascending) that are not kept yet; where none were painted, all become
    /// 0.
    void keep(Groom& groom, std::span<const std::uint32_t> strands);
    /// No more keep(): sorts by strand, drops those whose values are as they were. Where none is left, the
    /// groom is as it was before the first.
    void finish(Groom& groom);

    void exchange(Groom& groom);
    bool empty() const { return values_.empty(); }
    std::span<const std::uint32_t> strands() const {
        return values_.strands();
    }  ///< ascending after finish()
    std::size_t bytes() const { return values_.heapBytes(); }

  private:
    StrandValues<float> values_;
    bool absent_ = false;  ///< the groom on the other side has no such attribute
};

}  // namespace hairloom::editing
