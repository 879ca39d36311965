// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// New strands among those that there are.

#include <span>

#include "core/editing/root_grid.h"
#include "core/editing/strand_delta.h"
#include "core/operations/skin.h"

namespace hairloom::editing {

/// What new strands keep away from; nothing where `query` is null.
struct KeepOut {
    const SkinQuery* query = nullptr;
    float clearance = 0.001f;  ///< metres
};

/// All roots of a groom. Strands without points are left out.
RootGrid gridOfRoots(const Groom& groom, float cell);

/// Strands for these roots of the groom's head, to be put behind its own. Each is the mean of up to three
/// neighbours within `reach` metres, nearer ones counting more, turned with the skin from their roots to its
/// own, and has the attributes of the nearest; without neighbours, or with a reach of 0, it stands straight
/// out of the skin as the placement settings say. Ids are new, nothing is frozen, hidden or selected but
/// where the nearest neighbour is selected.
TakenStrands makeStrands(const Groom& groom, const RootGrid& grid, std::span<const SurfacePoint> roots,
                         float reach, const KeepOut& skin);

}  // namespace hairloom::editing
