// SPDX-License-Identifier: MIT
#pragma once
// What acts on strands from outside, for methods that step one strand at a time.

#include <array>

#include "hairloom/math.h"
#include "hairloom/wind.h"

namespace hairloom::runtime {

inline constexpr float kLargestAcceleration = 1e6f;  ///< m/s², of a root
inline constexpr float kFastest = 1e6f;              ///< m/s
inline constexpr float kLongestFrame = 1000.0f;      ///< seconds
inline constexpr double kLongestTime = 1e12;         ///< seconds; later ones leave gusts no phase

/// v, or what is `limit` long in its direction; zero for what is no number.
Float3 bounded(Float3 v, float limit);

inline Float3 mixed(Float3 a, Float3 b, float t) {
    return a + (b - a) * t;
}

/// m/s at a place in the world.
Float3 airAt(const Wind& wind, const std::array<float, kWindModes>& phases, Float3 position_ws);

}  // namespace hairloom::runtime
