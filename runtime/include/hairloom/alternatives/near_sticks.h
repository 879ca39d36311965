// SPDX-License-Identifier: MIT
#pragma once
// Sticks of other strands near the tips of sticks, for hair-hair collision of ProjectiveEquations.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hairloom/alternatives/point_cells.h"
#include "hairloom/host.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// For the tip of each stick the sticks of other strands that may come within reach in a frame. A stick is
/// named by its outer point.
///
/// Reach: of a tip and a stick the distance that make() was given, or what they have in the authored shape
/// where that is less, so that an authored style feels nothing.
///
/// Limits: at most kMost for a tip, the nearest at the start of the frame, within twice the reach of it then.
/// In the frame they move on evenly at the speed that they had.
class NearSticks {
  public:
    static constexpr std::size_t kMost = 8;
    struct Near {
        std::uint32_t stick;
        float reach;  ///< metres
    };

    /// `reach` in metres, above 0; else the spacing of the hair (hair_spacing.h).
    void make(const StrandsView& strands, float reach);
    /// Of positions in metres and velocities in m/s at the start of a frame, both by point.
    void find(std::span<const Float3> positions_ws, std::span<const Float3> velocities_ws, const Host& host);
    /// Of the tip of a stick, nearest first; those as near by their number.
    std::span<const Near> of(std::uint32_t stick) const { return {&found_[kMost * stick], counts_[stick]}; }
    /// The place on a stick that is nearest to `tip_ws`, that many seconds after the start of the frame.
    Float3 nearest(std::uint32_t stick, Float3 tip_ws, float seconds) const;
    float reach() const { return reach_; }  ///< metres

  private:
    void findOf(std::uint32_t stick);

    float reach_ = 0.0f, search_ = 0.0f, longest_ = 0.0f;
    std::vector<std::uint32_t> strands_;  // by point; a root has kRoot
    std::vector<Float3> rest_, from_ws_, velocities_ws_, middles_ws_;
    PointCells cells_;  // of the middles of sticks
    std::vector<Near> found_;
    std::vector<std::uint32_t> counts_;
};

/// The place on the line from `inner` to `outer` that is nearest to a point.
Float3 nearestOnStick(Float3 inner, Float3 outer, Float3 point);

}  // namespace hairloom::runtime
