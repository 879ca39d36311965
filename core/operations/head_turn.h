// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether two heads look the same way.

#include "core/operations/transfer.h"

namespace hairloom {

/// How the new head would have to be turned about the vertical to lie nearest to the one that the hair grows
/// on.
struct HeadTurn {
    int degrees = 0;     ///< 0, 90, 180 or 270, from +Z towards +X; 0 unless another is plainly nearer
    float distance = 0;  ///< metres, mean from the old head's surface near the hair to the turned one
    float unturned = 0;  ///< the same as it is
};
/// `groom` is bound to its head, and `fit` takes that to `head` as it is.
HeadTurn nearestTurn(const Groom& groom, const ScalpMesh& head, const HeadFit& fit);

/// Whether the fit is at the end of what it may scale: the heads are none of one size in any unit.
bool isBeyondScale(const HeadFit& fit);

}  // namespace hairloom
