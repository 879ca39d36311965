// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The ellipsoid that hair of benchmarks grows on.

#include <cmath>

#include "core/base/math.h"

namespace hairloom::cli {

/// A place on an ellipsoid of the size of a head around the origin, grown by a factor; angles in radians from
/// its crown and about the vertical.
inline Vec3f onBenchHead(float size, float down, float around) {
    return {size * 0.075f * std::sin(down) * std::cos(around), size * 0.11f * std::cos(down),
            size * 0.095f * std::sin(down) * std::sin(around)};
}

}  // namespace hairloom::cli
