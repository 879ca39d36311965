// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A painted mask of operators where it differs, to be exchanged with the groom's.

#include <cstdint>
#include <span>

#include "core/editing/strand_values.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

/// One mask (core/operations/mask.h) of touched strands. While it gathers, strands keep their indices and the
/// number of the mask is the same.
class MaskDelta {
  public:
    /// Keeps the values of the strands (ascending) that are not kept yet; a mask that is not there is made,
    /// 0 everywhere.
    void keep(Groom& groom, std::uint32_t number, std::span<const std::uint32_t> strands);
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
    StrandValues<float> values_;  ///< one value a strand
    std::uint32_t number_ = 0;
    bool absent_ = false;  ///< the groom on the other side has no such mask
};

}  // namespace hairloom::editing
