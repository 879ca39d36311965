// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that a program reconstructed from pictures, made such that it can be worked with.

#include <cstddef>
#include <cstdint>

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

struct HairCleaning {
    std::uint32_t points = 32;  ///< of each strand afterwards, ≥ 2
    float clearance = 0.0005f;  ///< metres that hair keeps from the head
    float reach = 0.03f;        ///< metres: roots farther from the scalp than this are no roots
};

/// What was done, in strands.
struct CleanedHair {
    std::size_t repeated = 0;  ///< left out: the same points as another
    std::size_t shorter = 0;   ///< left out: under 3 mm
    std::size_t outliers = 0;  ///< left out: far longer than the others, or rooted beyond the reach
    std::size_t loops = 0;     ///< had loops, which were cut out; or left out where little else was left
    std::size_t broken = 0;    ///< had a jump, behind which they were cut off
    std::size_t turned = 0;    ///< began at the tip
    std::size_t snapped = 0;   ///< had their root moved onto the scalp
    float farthestSnap = 0;    ///< metres
    std::size_t pushed = 0;    ///< were pushed out of the head
};

/// Repeated, short and far strands go; jumps and loops are cut out; strands that begin at their tip are
/// turned; points before a strand leaves the head go; all are resampled evenly. On a head roots are moved
/// onto its scalp, what follows them fading along the strand, strands are kept outside, and bound. What
/// points and strands carry comes along. Errors: no strand left, a number of points out of range.
Result<CleanedHair> cleanHair(Groom& groom, const HairCleaning& cleaning = {});

}  // namespace hairloom
