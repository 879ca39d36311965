// SPDX-License-Identifier: MIT
#pragma once
// Collision spheres of a frame, for methods that step one strand at a time.

#include <span>
#include <vector>

#include "hairloom/math.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Spheres that move evenly within a frame. Those that are no numbers are left out; those that jump do not
/// move.
class MovingSpheres {
  public:
    struct Moving {
        Float3 from_ws, motion;  ///< metres
        float radius = 0.0f;     ///< metres
    };
    /// Of capsules the spheres along them. Allocates only for more than ever before.
    void take(const FrameInput& input, float teleportDistance);
    /// The next spheres do not move.
    void forget() { last_.clear(); }
    std::span<const Moving> all() const { return moving_; }

  private:
    std::vector<Moving> moving_;
    std::vector<Sphere> now_, last_;
    std::vector<Float3> motions_;
};

}  // namespace hairloom::runtime
