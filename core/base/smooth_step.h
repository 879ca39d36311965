// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace hairloom {

/// From 0 to 1 with no slope at both ends. `t` is in [0, 1].
template <class T>
constexpr T smoothStep(T t) {
    return t * t * (3 - 2 * t);
}
/// Of where x is between two numbers, and 0 or 1 beyond them.
constexpr float smoothStep(float low, float high, float x) {
    return smoothStep(std::clamp((x - low) / (high - low), 0.0f, 1.0f));
}

}  // namespace hairloom
