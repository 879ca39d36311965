// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether two heads look the same way.

#include "core/operations/transfer.h"

namespace hairloom {

/// Metres: heads that are nearer than that to each other are alike as they are.
inline constexpr float kAlikeHeads_m = 0.0015f;

/// How the new head would have to be turned about the vertical to lie nearest to the one that the hair grows
/// on.
struct HeadTurn {
    int degrees = 0;     ///< 0, 90, 180 or 270, from +Z towards +X; 0 unless another is plainly nearer
    float distance = 0;  ///< metres on the old head, mean from its surface near the hair to the turned one
    float unturned = 0;  ///< the same as it is
};
/// `groom` is bound to its head. Each turn is fitted by itself.
HeadTurn nearestTurn(const Groom& groom, const ScalpMesh& head);

/// Whether the fit is at the end of what it may scale: the heads are none of one size in any unit.
bool isBeyondScale(const HeadFit& fit);

}  // namespace hairloom
