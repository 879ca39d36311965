// SPDX-License-Identifier: MIT
#pragma once
// What every runner of strands makes of a frame's input before it moves any: the engine here, and one on a
// GPU. Nothing here depends on how strands are stored.

#include <cstdint>
#include <span>

#include "engine/kernels.h"
#include "hairloom/memory.h"
#include "hairloom/plan.h"
#include "hairloom/strands.h"
#include "hairloom/wind.h"

namespace hairloom::runtime {

/// The spheres of a frame. Those that cannot be used stay in their place at radius 0.
struct FrameSpheres {
    Vector<Sphere> usable;        ///< those of the frame, then those along capsules
    std::size_t given = 0;        ///< of the frame
    Vector<Capsule> capsules;     ///< between usable ones, each pair once
    Vector<std::uint8_t> ends;    ///< 1 for a sphere that is the end of a capsule
    Vector<Float3> motion;        ///< each one's displacement during the frame; none for a cut
    Vector<std::uint8_t> ofSkin;  ///< 1 for a sphere of the frame that a body is met in the place of
    /// What a plan looks at: the usable ones, and a sphere around each capsule.
    Vector<Sphere> planned;
    Vector<Float3> plannedMotion;
    std::uint32_t rejected = 0;  ///< not finite or without radius
    /// Around a root within `radius` of which a sphere that has changed since the last frame may touch the
    /// hair: what sleeps there wakes up.
    Vector<Sphere> waking;
};
/// Metres; negative where the frame is cut: as far as nothing may move.
inline float teleportDistanceOf(const SimulationSettings& settings, const FrameInput& input) {
    return input.cut ? -1.0f : settings.teleportDistance;
}
/// What the last frame had: usable spheres, and capsules between these.
struct FormerSpheres {
    std::span<const Sphere> spheres;
    std::span<const Capsule> capsules;
    bool isCut = false;  ///< nothing of it says how fast spheres are
};
/// Room for so many of a frame: takeSpheres() of no more asks for no memory.
void reserveSpheres(std::size_t given, std::size_t capsules, FrameSpheres& spheres);
/// Keeps the memory of `spheres`.
void takeSpheres(const SimulationSettings& settings, float longestStrand, const FormerSpheres& before,
                 std::span<const Sphere> given, std::span<const Capsule> capsules, FrameSpheres& spheres);
/// Those with a radius, on their way through the frame's substeps, capsules as spheres along them.
void moveSpheres(const FrameSpheres& spheres, std::uint32_t substeps, Vector<MovingSphere>& moving);
/// Likewise, for what meets capsules as they are: their ends are none of the spheres. Those of skin come
/// last; returns how many come before them. Capsules of skin are nowhere near anything.
std::size_t moveCapsules(const FrameSpheres& spheres, std::uint32_t substeps, Vector<MovingSphere>& moving,
                         Vector<MovingCapsule>& capsules);

/// The wind of a frame.
struct FrameWind {
    Wind wind;
    bool given = false;  ///< by the frame, not by the settings alone
};
/// Takes the wind that the frame gives in place of the settings'; how many values of it were refused.
std::uint32_t takeWind(const SimulationSettings& settings, const FrameInput& input, FrameWind& wind);

/// What is known about the hair when a frame begins.
struct FramePlanInput {
    std::uint32_t strandCount = 0;
    std::uint32_t longestPointCount = 0;
    float longestStrand = 0.0f;  ///< metres
    bool straight = true;
    Float3 rootsMin_ws, rootsMax_ws;       ///< box of all roots over the frame
    float rootMotion = 0.0f;               ///< metres, the longest way of a root
    float fastest = 0.0f;                  ///< m/s, greatest speed of a point at the end of the last frame
    std::uint32_t asleep = 0;              ///< strands
    float restTime = 0.0f;                 ///< seconds
    float hairCell = 0.0f;                 ///< metres
    std::span<const float> poseAmounts{};  ///< of each pose
};
/// The plan of a frame of `frameTime` seconds.
EffectPlan planFrame(const SimulationSettings& settings, const FramePlanInput& planInput,
                     const FrameWind& wind, std::span<const Sphere> spheres,
                     std::span<const Float3> sphereMotion, float frameTime);

/// By how much numbers grow that were measured from one origin and are now measured from another.
Float3 shiftOfOrigin(const std::array<double, 3>& from_ws, const std::array<double, 3>& to_ws);
inline bool isFinite(const std::array<double, 3>& position) {
    return std::isfinite(position[0]) && std::isfinite(position[1]) && std::isfinite(position[2]);
}

/// Of the first of `substeps` of a frame of `dt` seconds.
SubstepContext substepContext(const SimulationSettings& settings, const EffectPlan& plan, float dt,
                              std::uint32_t substeps, std::span<const MovingSphere> spheres,
                              std::span<const MovingCapsule> capsules = {});

}  // namespace hairloom::runtime
