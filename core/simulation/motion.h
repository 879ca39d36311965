// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the head moves: the seam between whatever animates a character and the simulation.

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/animation/skinning.h"
#include "core/base/math.h"
#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

/// Where head and collision spheres are at one time; metres, world space.
struct HeadPose {
    /// Metres, in the world: all positions of the pose are measured from here, so that they keep their digits
    /// far away.
    Vec3d origin_ws = Vec3d::Zero();
    Eigen::Isometry3f head_ws = Eigen::Isometry3f::Identity();  ///< carries what no scalp vertex carries
    std::vector<Vec3f>
        scalpPositions_ws;  ///< per vertex of the groom's scalp; empty: the scalp moves with head_ws
    /// Per vertex of the scalp, as morph targets have it before bones move it; the head's rest space. Empty:
    /// at rest. What moves the scalp by bones alone reads it; scalpPositions_ws have it already.
    std::vector<Vec3f> morphed_ss;
    std::vector<Vec3f> sphereCentres_ws;  ///< per collision sphere; empty: spheres move with head_ws
    /// Of the scalp's skin, from the head at rest to the world; empty where no skeleton moves it.
    std::vector<Eigen::Affine3f> bones_ws;
    /// Per bone of the groom's body, likewise; empty: the body moves with head_ws.
    std::vector<Eigen::Affine3f> body_ws;
    std::optional<Vec3f> wind_ws;  ///< m/s, in place of the groom's mean wind
    /// Of each of the groom's poses from here on, 0 … 1; empty: they stay as they are.
    std::vector<float> poseAmounts{};
};

/// The same measured from the origin of the world.
HeadPose inWorld(HeadPose pose);

/// Moves all of it rigidly, measured from its origin; the wind stays.
void moveBy(const Eigen::Isometry3f& offset, HeadPose& pose);

class HeadMotion;

/// A step of a motion: where it ends, and the poses on the way there, at equal shares of its time.
struct HeadStep {
    HeadPose end;
    std::vector<HeadPose> within;  ///< empty: the head goes straight, or stays
};

/// Poses within a step, unless somebody asks for others: those at its quarters.
inline constexpr std::uint32_t kPosesWithin = 3;

HeadStep inWorld(HeadStep step);

/// Whether head, spheres and bones are the same in both; the wind may differ.
bool isSamePlace(const HeadPose& a, const HeadPose& b);
/// Whether all poses of a step are in the place of `before`: substeps see the same without those within.
bool staysThrough(const HeadPose& before, std::span<const HeadPose> within, const HeadPose& end);

/// The step from `before`, which is where the motion is at `from` seconds, to where it is at `to`. Where the
/// head stays on its pose, as in a clip that stands still, there are no poses within: substeps see the same
/// without them.
HeadStep stepOf(const HeadMotion& motion, const HeadPose& before, float from, float to,
                std::uint32_t posesWithin = kPosesWithin);

class HeadMotion {
  public:
    virtual ~HeadMotion() = default;
    /// The pose at `time` ≥ 0 seconds. Const and safe on any number of threads.
    virtual HeadPose poseAt(float time) const = 0;
    /// The settings at that time, where this keys some: `authored` with these.
    virtual std::optional<runtime::SimulationSettings> settingsAt(
        float time, const runtime::SimulationSettings& authored) const {
        static_cast<void>(time), static_cast<void>(authored);
        return std::nullopt;
    }
    /// The scalp's, whose bones the poses name; null where it moves without. Lives as long as this.
    virtual const SkinWeights* skin() const { return nullptr; }
};

/// The rigid motions that need no skeleton: "none"; "spin" (one turn a second about the vertical through the
/// head's middle, reached smoothly within half a second); "nod" (± 20° about the axis through the ears, 1.25
/// Hz). The pivot is the middle of the scalp selection's bounds, or of the strands' roots where there is no
/// scalp. Error: unknown name, listing those there are.
Result<std::unique_ptr<HeadMotion>> makeRigidMotion(std::string_view name, const Groom& groom);

}  // namespace hairloom
