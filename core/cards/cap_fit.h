// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Sets how dense the cap is by what is seen of the skin: beside strands, from all sides.

#include "core/cards/judge.h"

namespace hairloom::cards {

/// Which places of the cap the pixels of some views look at, through whatever hair there is before them.
class CapSight {
  public:
    CapSight(const Hair& hair, const std::vector<CapChart>& cap, std::span<const View> views,
             std::uint32_t headPx);
    /// Sets CapChart::wanted so that of the skin under each square as much is seen as strands leave bare.
    /// Without a head they stay as they are. `strands` and `level` are shots of the views, and the level's
    /// those of these cards with the cap as the atlas has it now.
    void fit(std::span<const Shot> strands, std::span<const Shot> level, Cards& cards) const;

  private:
    struct Pixel {
        std::uint32_t at;  ///< of the picture
        std::uint32_t chart;
        Vec2f place;  ///< in squares
    };
    std::vector<std::vector<Pixel>> pixels_;  ///< of each view, those that look at the cap
};

}  // namespace hairloom::cards
