// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hairloom {

/// Control points of the cubic Bézier curves that Hermite curves are, three numbers each: `tangents` are the
/// derivatives at `points`, one span from each point to the next. Both are as long; `counts` add up to them.
std::vector<float> bezierOfHermite(std::span<const std::uint32_t> counts, std::span<const float> points,
                                   std::span<const float> tangents);

}  // namespace hairloom
