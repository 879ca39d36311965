// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A strand laid away from a parting.

#include <span>

#include "core/operations/drawn_curve.h"
#include "core/operations/skin.h"

namespace hairloom {

struct PartingForce {
    float strength = 1;      ///< 0 … 1
    float reach = 0.07f;     ///< metres from the parting at which hair is as it was
    float liftDegrees = 25;  ///< to the skin, at the root
    float rise = 0.03f;      ///< metres from the root over which that angle is lost
};

/// Turns segments to the side of the line on which the root lies; root and `lengths` stay. `outward` is the
/// skin's normal at the root, and the skin's everywhere where `skin` is null. False: out of reach, unchanged.
bool layAwayFrom(const CurveLine& line, const PartingForce& force, std::span<Vec3f> points,
                 std::span<const float> lengths, const Vec3f& outward, const SkinQuery* skin);

}  // namespace hairloom
