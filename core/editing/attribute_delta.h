// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Painted values where they differ, to be exchanged with the groom's.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/editing/strand_values.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

/// One attribute of numbers, of touched strands or of their points. While it gathers, strands keep their
/// indices and numbers of points, and the attribute is the same.
class AttributeDelta {
  public:
    enum class Of { strands, points };

    explicit AttributeDelta(Of of) : of_(of) {}

    /// Keeps the values of the strands (ascending) that are not kept yet; an attribute that is not there is
    /// made, 0 everywhere.
    void keep(Groom& groom, std::string_view name, std::span<const std::uint32_t> strands);
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
    AttributeSet& attributesOf(Groom& groom) const;
    std::vector<float>& valuesOf(Groom& groom) const;
    /// Where the values of each strand begin; made in `ones` where a strand has one.
    std::span<const std::uint32_t> offsetsOf(const Groom& groom, std::vector<std::uint32_t>& ones) const;

    Of of_;
    std::string name_;
    StrandValues<float> values_;
    bool absent_ = false;  ///< the groom on the other side has no such attribute
};

}  // namespace hairloom::editing
