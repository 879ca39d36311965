// SPDX-License-Identifier: MIT
#pragma once
// What sticks of other strands do to the tips of sticks, for hair-hair collision of ProjectiveEquations.

#include <cstdint>
#include <span>
#include <vector>

#include "hairloom/alternatives/point_cells.h"
#include "hairloom/host.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// For the tip of each stick the way out of the reach of other strands' sticks, and out of their way. A stick
/// is named by its outer point.
///
/// Reach: of a tip and a stick the distance that make() was given, or what they have in the authored shape
/// where that is less, so that an authored style feels nothing.
///
/// A tip takes half of each: the other stick, or its tip, takes the other half. What several sticks ask adds
/// up, to no more than the most that one of them asks.
///
/// Same bits for any number of threads: all see the strands as they were when find() was called, and a tip
/// adds in the order of the points.
class NearSticks {
  public:
    /// `reach` in metres, above 0; else the spacing of the hair (hair_spacing.h).
    void make(const StrandsView& strands, float reach);
    /// Of positions in metres and velocities in m/s, both by point.
    void find(std::span<const Float3> positions_ws, std::span<const Float3> velocities_ws, const Host& host);
    struct Away {
        Float3 push;   ///< metres
        Float3 brake;  ///< m/s
    };
    const Away& of(std::uint32_t stick) const { return away_[stick]; }
    float reach() const { return reach_; }  ///< metres

  private:
    Away findOf(std::uint32_t stick) const;

    float reach_ = 0.0f, longest_ = 0.0f;
    std::vector<std::uint32_t> strands_;  // by point; a root has none
    std::vector<Float3> rest_, positions_ws_, velocities_ws_, middles_ws_;
    PointCells cells_;  // of the middles of sticks
    std::vector<Away> away_;
};

/// Where on the line from `inner` to `outer`, 0…1, the place is that is nearest to a point.
float nearestOnStick(Float3 inner, Float3 outer, Float3 point);

}  // namespace hairloom::runtime
