// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A scene that is run over and over with different settings, and what its hair did: the positions of the same
// material points in every frame, whatever the number of points that a strand was simulated with.

#include <cstdint>
#include <span>
#include <vector>

#include "core/simulation/simulation.h"

namespace hairloom {

class StrandFollow;

/// Hair to run, and where along each strand its points are.
struct SceneHair {
    Groom groom;
    /// Per point, the share 0 … 1 of the authored strand's arc length at which it sits.
    std::vector<float> arcShares;
};

/// `count` strands drawn with the seed, in their order; all of them where there are no more. Spheres, scalp
/// and settings stay; the triangulation, which is of all roots, goes. Points as authored.
SceneHair sampleStrands(const Groom& groom, std::size_t count, std::uint64_t seed);

/// These strands, ascending, as sampleStrands() has them.
SceneHair strandsOf(const SceneHair& hair, std::span<const std::uint32_t> strands);

/// The same strands with `points` ≥ 2 points each, evenly spaced by arc length. Point attributes other than
/// the position go, and operators with them.
SceneHair resampledHair(const SceneHair& hair, std::uint32_t points);

/// Points of the strand that has most; 0 without strands.
std::uint32_t maxPoints(const Groom& groom);

/// How long, how often, and where the head is.
struct SceneTime {
    std::uint32_t frames = 60;
    float framesPerSecond = 60;
    /// Steps of the engine in each frame, each to the head's pose at its end.
    std::uint32_t stepsPerFrame = 1;
    /// Poses that the engine is given within each step, at equal shares of it.
    std::uint32_t posesWithin = kPosesWithin;
    bool seesWithin = true;  ///< false: it is given the end of each step alone, out of the same poses
};

/// The poses of a run, `posesWithin` + 1 for each step behind the start, poses[0]. Made once for many runs,
/// because a clip skins the whole head for each.
std::vector<HeadPose> posesOf(const HeadMotion& motion, const SceneTime& time);
/// Of these the start, and the one at the end of each frame.
std::vector<HeadPose> framePosesOf(std::span<const HeadPose> poses, const SceneTime& time);

/// Material points at the end of each frame.
struct Trajectory {
    std::uint32_t frames = 0;
    std::size_t pointsPerFrame = 0;
    std::vector<Vec3f> points_ws;  ///< frame after frame; metres

    /// False also for a run that was broken off.
    bool finite = true;
};

/// How far apart two trajectories of the same material points are.
struct TrajectoryError {
    double rmsMm = 0;  ///< root mean square over points and frames
    double maxMm = 0;
};
/// Both are finite and of the same size.
TrajectoryError compare(const Trajectory& run, const Trajectory& groundTruth);

/// `count` shares of the arc length, evenly spaced, from the first beyond the root to the tip.
std::vector<float> evenShares(std::uint32_t count);

/// The points of strands that a run is compared by: on each of `strands`, ascending, those at `shares` of
/// its arc length, ascending.
struct Followed {
    std::vector<std::uint32_t> strands;
    std::vector<float> shares;
};
/// `count` of the strands, drawn with the seed; all of them where there are no more.
std::vector<std::uint32_t> drawnStrands(const Groom& groom, std::size_t count, std::uint64_t seed);

/// Where followed points lie between the points of their strands.
class MaterialPoints {
  public:
    MaterialPoints(const SceneHair& hair, const Followed& followed);
    std::size_t count() const { return places_.size(); }
    /// Appends the positions; false when one of them is not finite. `positions_ws` are all points of the
    /// hair.
    bool read(std::span<const Vec3f> positions_ws, std::vector<Vec3f>& into_ws) const;

  private:
    struct Place {
        std::uint32_t from;
        float t;  ///< of the way from point `from` to the next
    };
    std::vector<Place> places_;
};

struct SceneResult {
    Trajectory trajectory;            ///< empty without followed points
    double millisecondsPerFrame = 0;  ///< mean of the engine's own time; all steps of a frame together
    std::uint64_t stateHash = 0;
    std::uint64_t nanCount = 0;
    std::uint64_t restoredStrands = 0;  ///< see SimulationStats
    double sphereDepthMm = 0;           ///< deepest point inside a sphere, over all frames
    std::vector<EffectReport> effects;  ///< after the last frame
};

/// Runs the hair with its groom's settings, from rest. A run that follows points is broken off at the first
/// that is not finite. Errors: those of Simulation::make.
/// With `followers`, hairs that follow its strands are made in every frame, and their time counts.
Result<SceneResult> runScene(const SceneHair& hair, std::span<const HeadPose> poses, const SceneTime& time,
                             const Followed& followed, const SimulationOptions& options = {},
                             const StrandFollow* followers = nullptr);

}  // namespace hairloom
