// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which strands lead locks, and which of some roots is nearest.

#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

/// Chosen roots by cells of one spacing, so that all within one spacing lie in the 27 cells around.
class CentreGrid {
  public:
    /// `groom` must outlive it.
    CentreGrid(const Groom& groom, float spacing) : groom_(groom), spacing_(spacing) {}

    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    /// The nearest chosen strand within one spacing, or kNone.
    std::uint32_t nearest(const Vec3f& root) const;
    void add(std::uint32_t strand);

  private:
    using Cell = std::array<std::int64_t, 3>;
    Cell cellOf(const Vec3f& p) const;
    static std::uint64_t keyOf(const Cell& cell);

    const Groom& groom_;
    float spacing_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// For each strand the nearest chosen strand by root. Strands are chosen in random order wherever no chosen
/// root is nearer than `spacing` metres (> 0); a chosen strand names itself. Strands of fewer than 2 points
/// name themselves and are never chosen for others.
std::vector<std::uint32_t> chooseCentres(const Groom& groom, float spacing, std::uint64_t seed);

}  // namespace hairloom
