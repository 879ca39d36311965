// SPDX-License-Identifier: MIT
#include "models/alternatives/surroundings.h"

#include <cmath>
#include <numbers>

#include "hairloom/alternatives/moving_spheres.h"

namespace hairloom::runtime {

Float3 bounded(Float3 v, float limit) {
    const float size = length(v);
    if (size <= limit) return v;
    return std::isfinite(size) ? v * (limit / size) : Float3{};
}

Float3 airAt(const Wind& wind, const std::array<float, kWindModes>& phases, Float3 position_ws) {
    Float3 sum = wind.mean;
    for (std::size_t m = 0; m < kWindModes; ++m) {
        const float turns = dot(position_ws, wind.modes[m].waveVector) + phases[m];
        sum = sum + wind.modes[m].amplitude * std::sin(2.0f * std::numbers::pi_v<float> * turns);
    }
    return sum;
}

void MovingSpheres::take(std::span<const Sphere> spheres, float teleportDistance) {
    moving_.clear();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Sphere& now = spheres[i];
        if (!isFinite(now.center_ws) || !std::isfinite(now.radius) || !(now.radius > 0.0f)) continue;
        Float3 motion;
        if (i < last_.size() && isFinite(last_[i].center_ws)) {
            motion = now.center_ws - last_[i].center_ws;
            if (!(length(motion) <= teleportDistance)) motion = {};
        }
        moving_.push_back({now.center_ws - motion, motion, now.radius});
    }
    last_.assign(spheres.begin(), spheres.end());
}

}  // namespace hairloom::runtime
