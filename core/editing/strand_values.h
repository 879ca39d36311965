// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Values of the points of touched strands as they were, to be exchanged with those that there are.

#include <cstdint>
#include <span>
#include <vector>

namespace hairloom::editing {

/// `offsets` are the groom's, `values` one for each of its points. While it gathers, strands keep their
/// indices and numbers of points. T is a float or a vector of floats.
template <class T>
class StrandValues {
  public:
    using Offsets = std::span<const std::uint32_t>;

    /// Keeps the values of the strands that are not kept yet.
    void keep(Offsets offsets, std::span<const T> values, std::span<const std::uint32_t> strands);
    /// As they were when kept; empty for a strand that is not kept.
    std::span<const T> kept(std::uint32_t strand) const;
    /// No more keep() or kept(): sorts by strand, drops those whose values are as they were, bit by bit.
    void finish(Offsets offsets, std::span<const T> values);

    void exchange(Offsets offsets, std::span<T> values);
    bool empty() const { return strands_.empty(); }
    /// Ascending after finish().
    std::span<const std::uint32_t> strands() const { return strands_; }
    std::size_t heapBytes() const;

  private:
    std::span<const T> ofPlace(std::size_t k) const {
        return std::span(values_).subspan(begins_[k], begins_[k + 1] - begins_[k]);
    }

    std::vector<std::uint32_t> strands_;
    std::vector<std::uint32_t> begins_{0};  ///< strand k owns values [begins_[k], begins_[k + 1])
    std::vector<T> values_;
    std::vector<std::uint32_t> slots_;  ///< per strand 1 + its place in strands_, or 0; empty once finished
};

}  // namespace hairloom::editing
