// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How different two pictures look to somebody who flips between them: LDR-FLIP (Andersson et al. 2020, "FLIP:
// A Difference Evaluator for Alternating Images"). Written after the paper; equation numbers are its.

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

struct FlipDifference {
    double mean = 0;     ///< 0 the same … 1 as different as can be
    double largest = 0;  ///< of all pixels
    Image map;           ///< the difference of each pixel: black is none, yellow the most
};

/// Alpha does not count. `pixelsPerDegree`: 67 is a display of 3840 pixels and 0.7 m seen from 0.7 m. Errors:
/// no pixels, or pictures of different sizes.
Result<FlipDifference> flipDifference(const Image& reference, const Image& test, double pixelsPerDegree = 67);

}  // namespace hairloom::render
