// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Sideways and outwards along a strand, alike on neighbouring strands.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace hairloom {

/// Orthonormal at each point.
struct StrandFrame {
    Vec3f lateral;  ///< along the skin
    Vec3f outward;  ///< out of it
    Vec3f along;    ///< towards the tip
};
/// Carried along the strand, with no turn about it, from where it stands out of the skin least. `outward` is
/// the skin's normal at the root, a unit vector.
std::vector<StrandFrame> strandFrames(std::span<const Vec3f> points, const Vec3f& outward);

/// Smooth random waves: value noise with a smooth step between the integers; each component in [−1, 1].
Vec3f waveAt(std::uint64_t stream, float x);

inline Vec3f unitOr(const Vec3f& v, const Vec3f& fallback) {
    constexpr float kTiny = 1e-6f;
    const float norm = v.norm();
    return norm > kTiny ? Vec3f(v / norm) : fallback;
}

}  // namespace hairloom
