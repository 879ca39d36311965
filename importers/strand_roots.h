// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where strands are rooted on a head that they are imported to.

#include "importers/raw_strands.h"

namespace hairloom {

/// Turns all strands when the last point of most of them is plainly the one nearer to the scalp; else the
/// file's order stands. Metres, Y up.
void orientToScalp(RawStrands& strands, const ScalpMesh& scalp);

/// An error when the roots lie farther from the head than it is large, and half a metre at least; a warning
/// when they lie more than a centimetre away. Both name the unit and axis (`--unit`, `--up`) that would
/// plainly put them onto it. `strands` are in metres and Y up as the options made them.
Status checkRootDistance(RawStrands& strands, const ScalpMesh& scalp, const StrandImportOptions& options);

}  // namespace hairloom
