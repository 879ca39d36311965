// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Points and flags of some strands as they were, to be exchanged with those of the groom.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/editing/strand_values.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

/// Positions of touched strands. While it gathers, strands keep their indices and numbers of points.
class PointDelta {
  public:
    /// Keeps the points of the strands that are not kept yet.
    void keep(const Groom& groom, std::span<const std::uint32_t> strands) {
        points_.keep(groom.offsets.view(), groom.positions(), strands);
    }
    /// As they were when kept; empty for a strand that is not kept.
    std::span<const Vec3f> kept(std::uint32_t strand) const { return points_.kept(strand); }
    /// No more keep() or kept(): sorts by strand, drops those whose points are as they were.
    void finish(const Groom& groom) { points_.finish(groom.offsets.view(), groom.positions()); }

    void exchange(Groom& groom) {
        if (empty()) return;
        points_.exchange(groom.offsets.view(), groom.pointAttributes.edit<Vec3f>(attribute::kPosition));
    }
    bool empty() const { return points_.empty(); }
    /// Ascending after finish().
    std::span<const std::uint32_t> strands() const { return points_.strands(); }
    std::size_t bytes() const { return points_.heapBytes(); }

  private:
    StrandValues<Vec3f> points_;
};

/// One uint8 attribute of some strands (selected, hidden, frozen).
class FlagDelta {
  public:
    explicit FlagDelta(std::string_view attribute) : attribute_(attribute) {}
    /// Sets the flag of these strands (ascending); those that have it already are left out.
    void set(Groom& groom, std::span<const std::uint32_t> strands, bool value);

    void exchange(Groom& groom);
    bool empty() const { return strands_.empty(); }
    std::span<const std::uint32_t> strands() const { return strands_; }  ///< ascending
    std::size_t bytes() const { return strands_.capacity() * 5; }
    const std::string& attribute() const { return attribute_; }

  private:
    std::string attribute_;
    std::vector<std::uint32_t> strands_;
    std::vector<std::uint8_t> values_;
    bool absent_ = false;  ///< the groom on the other side has no such attribute
};

}  // namespace hairloom::editing
