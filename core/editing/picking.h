// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is under the cursor: the head, a strand.

#include <optional>

#include "core/editing/strand_bounds.h"
#include "core/editing/view.h"
#include "core/geometry/closest_point.h"

namespace hairloom::editing {

/// Which part of a strand answers.
enum class StrandPart { Any, Root, Tip };

struct PickOptions {
    float radius_px = 6;  ///< pixels around the cursor
    StrandPart part = StrandPart::Any;
    /// Hair behind the head counts too.
    bool throughHead = false;
};

struct StrandPick {
    std::uint32_t strand;
    std::uint32_t segment;  ///< between points segment and segment + 1
    float along;            ///< 0 … 1 in the segment
    Vec3f position_ss;
    float distance_px;
    float depth;  ///< metres along the view
};

/// Where the head is under the cursor. `surface` may be null.
std::optional<SurfaceTree::Hit> pickHead(const SurfaceTree* surface, const View& view, const Vec2f& px);

/// The strand nearest to the cursor on the screen, and of those equally near to the pixel the one in front.
/// Hidden strands and those of invisible layers are not there. `bounds` fit the groom; `surface` may be null.
std::optional<StrandPick> pickStrand(const Groom& groom, const StrandBounds& bounds,
                                     const SurfaceTree* surface, const View& view, const Vec2f& px,
                                     const PickOptions& options = {});

/// 1 for each strand that is shown: not hidden, on a visible layer.
std::vector<std::uint8_t> shownStrands(const Groom& groom);

}  // namespace hairloom::editing
