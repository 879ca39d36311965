// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where strands are rooted on a head that they are imported to.

#include "importers/raw_strands.h"

namespace hairloom {

/// Turns all strands when the last point of most of them is plainly the one nearer to the scalp; else the
/// file's order stands. Metres, Y up.
void orientToScalp(RawStrands& strands, const ScalpMesh& scalp);

/// An error when the roots lie farther from the head than it is large, and half a metre at least, naming the
/// unit of `--unit` that would put them on it. `strands` are in metres at `metresPerUnit`.
Status checkRootDistance(const RawStrands& strands, const ScalpMesh& scalp, float metresPerUnit);

}  // namespace hairloom
