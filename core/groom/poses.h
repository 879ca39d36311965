// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Poses of a groom: other shapes of its strands, which simulated hair follows by an amount that an animator
// keys. The shape is a point attribute, so that it goes wherever strands go.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/groom/groom_pose.h"
#include "hairloom/strands.h"

namespace hairloom {

struct Finding;
struct Groom;

inline constexpr std::size_t kMaxGroomPoses = runtime::kMaxPoses;
inline constexpr std::size_t kMaxPoseName = 64;
/// Of a point of a pose from the origin, along each axis; metres, as validate() has it of positions.
inline constexpr float kFarthestPosed = 1e6f;

/// "pose.NAME": float3 per point, metres, in the scalp's rest space. The directions of its segments count.
inline constexpr std::string_view kPosePrefix = "pose.";
std::string poseAttribute(std::string_view name);

/// Its place in Groom::poses.
std::optional<std::size_t> findPose(const Groom& groom, std::string_view name);
/// The same. Error: there is none of that name, listing those there are.
Result<std::size_t> placeOfPose(const Groom& groom, std::string_view name);
/// Whether a pose knows a strand, by the points that it has of it: those of one that came later are all in
/// one place.
bool knowsStrand(std::span<const Vec3f> posed);
/// "Pose 1", "Pose 2", …: the first that is free.
std::string freshPoseName(const Groom& groom);
/// Errors: a name that is empty, too long or has control characters.
Status checkPoseName(std::string_view name);

/// One more pose, or another shape of the pose of that name, which keeps its settings. Errors: as
/// checkPoseName(), another number of points, too many poses, a position that is not finite.
Status putPose(Groom& groom, const std::string& name, std::span<const Vec3f> positions);
/// The shape that `other` has, as a pose of `groom`: strands of the same ids where both have ids, else in
/// their order. Errors: as putPose(), other strands, or strands of other numbers of points.
Status putPoseOf(Groom& groom, const std::string& name, const Groom& other);
/// Strands get the shape of the pose, on their roots, and the pose that of the strands. Those that it does
/// not know stay. Errors: as placeOfPose(), a groom with operators, which make the shape of its strands.
Status swapPose(Groom& groom, const std::string& name);
/// With its shape. Errors: as placeOfPose().
Status removePose(Groom& groom, const std::string& name);

/// How much of the amount each point takes, 0 … 1: the mask's share times the ramp's. A strand that the pose
/// does not know, since it came later, takes none. Empty: 1 everywhere.
std::vector<float> poseWeights(const Groom& groom, const GroomPose& pose);
/// Poses as engines take them; of the groom, which stays, and of these weights.
struct PoseViews {
    std::vector<std::vector<float>> weights;
    std::vector<runtime::PoseView> views;
};
PoseViews poseViews(const Groom& groom);
/// Of all poses, in their order.
std::vector<float> poseAmounts(const Groom& groom);
/// Some amount is above 0, or the time line keys one.
bool followsPoses(const Groom& groom);

/// What does not hold. Warnings: nothing follows the pose, but the hair can be simulated.
std::vector<Finding> findPoseProblems(const Groom& groom);

}  // namespace hairloom
