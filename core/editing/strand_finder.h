// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands by where they are.

#include <vector>

#include "core/editing/brush_volume.h"
#include "core/editing/strand_bounds.h"

namespace hairloom::editing {

/// Ascending; those whose root, or else any part, is in the volume. Hidden and frozen ones as well.
std::vector<std::uint32_t> strandsWithin(const Groom& groom, const StrandBounds& bounds,
                                         const BrushVolume& volume, bool byRoots);

inline bool isHidden(const Groom& groom, std::size_t strand) {
    const auto hidden = groom.strandAttributes.view<std::uint8_t>(attribute::kHidden);
    return strand < hidden.size() && hidden[strand] != 0;
}

}  // namespace hairloom::editing
