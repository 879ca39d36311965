// SPDX-License-Identifier: MIT
#pragma once
// What acts on strands from outside, for methods that step one strand at a time.

#include <array>
#include <cstddef>
#include <vector>

#include "hairloom/math.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"
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

/// Axis times angle, 0…π, of a rotation.
Float3 rotationVector(Quat q);

/// Of all strands; without a rotation where the strands have none.
std::vector<RootFrame> rootsAtRest(const StrandsView& strands);

/// B of the rod at `along` (0…1) its strand, for hair that weighs 1 per metre: m⁴/s². Infinite at
/// stiffness 1. `ofStrand` as StrandsView::stiffness.
double rodStiffness(const SimulationSettings& settings, float along, float ofStrand);

/// A frame's input, and the gusts at its start and end.
struct WindyFrame {
    const FrameInput& input;
    std::array<float, kWindModes> windFrom, windTo;

    WindyFrame(const Wind& wind, const FrameInput& frameInput);
};

/// How a root goes through a frame.
struct RootPath {
    RootFrame from, to;
    Float3 acceleration;  ///< m/s²
    bool jumps = false;   ///< the strand is carried by `turn` to where `from` is now
    Quat turn;

    /// Takes `now` and `velocity` (m/s, over the frame before) to the frame's end. A root that is no position
    /// within kFarthest stays; one that goes farther than teleportDistance jumps.
    RootPath(RootFrame& now, Float3& velocity, const RootFrame& wanted, float dt, float teleportDistance);
};

/// m/s at the root and the tip of a strand, at the start and the end of a frame.
struct AirPath {
    Float3 rootFrom, rootTo, tipFrom, tipTo;

    /// `tip` is measured from the root, world axes.
    AirPath(const Wind& wind, const WindyFrame& frame, const RootPath& path, Float3 tip);
    Float3 atRoot(float share) const { return mixed(rootFrom, rootTo, share); }
    Float3 atTip(float share) const { return mixed(tipFrom, tipTo, share); }
};

}  // namespace hairloom::runtime
