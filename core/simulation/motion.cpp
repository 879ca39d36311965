// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hairloom {
namespace {

/// Turns the head about a fixed axis through a pivot.
class TurnMotion : public HeadMotion {
  public:
    using AngleAt = float (*)(float time);

    TurnMotion(const Vec3f& pivot_ws, const Vec3f& axis_ws, AngleAt angleAt)
        : pivot_ws_(pivot_ws), axis_ws_(axis_ws), angleAt_(angleAt) {}

    HeadPose poseAt(float time) const override {
        HeadPose pose;
        pose.head_ws = Eigen::Translation3f(pivot_ws_) * Eigen::AngleAxisf(angleAt_(time), axis_ws_) *
                       Eigen::Translation3f(-pivot_ws_);
        return pose;
    }

  private:
    Vec3f pivot_ws_;
    Vec3f axis_ws_;
    AngleAt angleAt_;
};

class RestMotion : public HeadMotion {
  public:
    HeadPose poseAt(float) const override { return {}; }
};

/// Radians. The angular speed rises over half a second as a smoothstep, so that the start is no blow; the
/// integral of 3s² − 2s³ over the ramp is half its length.
float spinAngle(float time) {
    if (time <= 0) return 0;
    constexpr float kTurnsPerSecond = 1.0f;
    constexpr float kRamp = 0.5f;
    const float s = std::min(time / kRamp, 1.0f);
    const float rampedTime = kRamp * (s * s * s - 0.5f * s * s * s * s) + std::max(time - kRamp, 0.0f);
    return 2 * kPi * kTurnsPerSecond * rampedTime;
}

/// Radians, starting at rest: the amplitude rises over the first half period.
float nodAngle(float time) {
    if (time <= 0) return 0;
    constexpr float kFrequency = 1.25f;
    const float rise = std::min(time * 2 * kFrequency, 1.0f);
    const float smoothRise = rise * rise * (3 - 2 * rise);
    return radians(20.0f) * smoothRise * std::sin(2 * kPi * kFrequency * time);
}

Vec3f pivotOf(const Groom& groom) {
    Box3f bounds;
    if (groom.scalp && !groom.scalpSelection.empty()) {
        for (const std::uint32_t triangle : groom.scalpSelection) {
            for (const std::uint32_t vertex : groom.scalp->triangles()[triangle]) {
                bounds.extend(groom.scalp->positions()[vertex]);
            }
        }
    } else {
        for (std::size_t s = 0; s < groom.strandCount(); ++s) bounds.extend(groom.strand(s).front());
    }
    return bounds.isEmpty() ? Vec3f(Vec3f::Zero()) : Vec3f(bounds.center());
}

}  // namespace

HeadPose inWorld(HeadPose pose) {
    const Vec3f origin = pose.origin_ws.cast<float>();
    pose.head_ws.pretranslate(origin);
    for (Vec3f& position : pose.scalpPositions_ws) position += origin;
    for (Vec3f& centre : pose.sphereCentres_ws) centre += origin;
    for (auto* bones : {&pose.bones_ws, &pose.body_ws}) {
        for (Eigen::Affine3f& bone : *bones) bone.pretranslate(origin);
    }
    pose.origin_ws.setZero();
    return pose;
}

void moveBy(const Eigen::Isometry3f& offset, HeadPose& pose) {
    pose.head_ws = offset * pose.head_ws;
    for (Vec3f& position : pose.scalpPositions_ws) position = offset * position;
    for (Vec3f& centre : pose.sphereCentres_ws) centre = offset * centre;
    for (auto* bones : {&pose.bones_ws, &pose.body_ws}) {
        for (Eigen::Affine3f& bone : *bones) bone = offset * bone;
    }
}

HeadStep inWorld(HeadStep step) {
    step.end = inWorld(std::move(step.end));
    for (HeadPose& pose : step.within) pose = inWorld(std::move(pose));
    return step;
}

bool isSamePlace(const HeadPose& a, const HeadPose& b) {
    const auto sameBones = [](const std::vector<Eigen::Affine3f>& x, const std::vector<Eigen::Affine3f>& y) {
        return std::ranges::equal(x, y,
                                  [](const auto& m, const auto& n) { return m.matrix() == n.matrix(); });
    };
    return a.origin_ws == b.origin_ws && a.head_ws.matrix() == b.head_ws.matrix() &&
           a.sphereCentres_ws == b.sphereCentres_ws && sameBones(a.bones_ws, b.bones_ws) &&
           sameBones(a.body_ws, b.body_ws) && a.scalpPositions_ws == b.scalpPositions_ws &&
           a.morphed_ss == b.morphed_ss;
}

bool staysThrough(const HeadPose& before, std::span<const HeadPose> within, const HeadPose& end) {
    const auto stays = [&](const HeadPose& pose) { return isSamePlace(pose, before); };
    return stays(end) && std::ranges::all_of(within, stays);
}

HeadStep stepOf(const HeadMotion& motion, const HeadPose& before, float from, float to,
                std::uint32_t posesWithin) {
    HeadStep step{motion.poseAt(to), {}};
    for (std::uint32_t i = 1; i <= posesWithin; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(posesWithin + 1);
        step.within.push_back(motion.poseAt(from + (to - from) * share));
    }
    if (staysThrough(before, step.within, step.end)) step.within.clear();
    return step;
}

Result<std::unique_ptr<HeadMotion>> makeRigidMotion(std::string_view name, const Groom& groom) {
    if (name == "none") return std::make_unique<RestMotion>();
    if (name == "spin") return std::make_unique<TurnMotion>(pivotOf(groom), Vec3f::UnitY(), spinAngle);
    if (name == "nod") return std::make_unique<TurnMotion>(pivotOf(groom), Vec3f::UnitX(), nodAngle);
    return fail(fmt::format("there is no motion '{}'", name),
                "expected none, spin, nod, clip:NAME, timeline or a keyframe file F.json");
}

}  // namespace hairloom
