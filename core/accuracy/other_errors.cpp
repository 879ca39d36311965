// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/other_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/parallel.h"
#include "core/operations/skin.h"
#include "hairloom/stable.h"

namespace hairloom {
namespace {

constexpr float kFramesPerSecond = 60;
constexpr auto kRestFrames = static_cast<std::uint32_t>(runtime::kTrialSeconds * 60);
constexpr std::uint32_t kShakeFrames = 60;
constexpr double kShakeMetres = 0.1, kShakeHertz = 2;
constexpr std::uint32_t kLastFrames = 10;  // that speeds are taken from

/// To and fro, from rest to rest.
HeadPose shaken(HeadPose pose, std::uint32_t frame) {
    const double share = static_cast<double>(frame) / kShakeFrames;
    const double seconds = static_cast<double>(frame) / static_cast<double>(kFramesPerSecond);
    const double swell = std::pow(std::sin(std::numbers::pi * share), 2);
    pose.origin_ws.x() += kShakeMetres * swell * std::sin(2 * std::numbers::pi * kShakeHertz * seconds);
    return inWorld(std::move(pose));
}

double rmsMm(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>((a[i] - b[i]).squaredNorm());
    return 1e3 * std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

bool isFinite(std::span<const Vec3f> points) {
    return std::ranges::all_of(points, [](const Vec3f& point) { return point.allFinite(); });
}

/// Lets the hair stand; the speed of the fastest point in the last frames, m/s.
double letRest(Simulation& simulation, const HeadPose& pose) {
    std::vector<Vec3f> before;
    float farthest = 0;
    for (std::uint32_t frame = 0; frame < kRestFrames; ++frame) {
        simulation.step(1 / kFramesPerSecond, pose);
        if (frame + kLastFrames + 1 < kRestFrames) continue;
        const auto now = simulation.positions_ws();
        for (std::size_t i = 0; i < before.size(); ++i)
            farthest = std::max(farthest, (now[i] - before[i]).norm());
        before.assign(now.begin(), now.end());
    }
    return static_cast<double>(farthest * kFramesPerSecond);
}

/// The head's mesh in a pose, and where points of the world are to it.
class PosedHead {
  public:
    /// `atRest` serves poses that move the head as a whole.
    PosedHead(const Skin& atRest, const HeadPose& pose)
        : skin_(&atRest), origin_(pose.origin_ws.cast<float>()) {
        if (pose.scalpPositions_ws.empty()) {
            toHead_ = pose.head_ws.inverse();
        } else {
            moved_.emplace(std::make_shared<const ScalpMesh>(atRest.mesh().moved(pose.scalpPositions_ws)));
            skin_ = &*moved_;
        }
    }
    /// Metres, ≥ 0.
    float depthAt(const Vec3f& point_ws) const {
        return std::max(0.0f, -skin_->distanceAt(toHead_ * Vec3f(point_ws - origin_)).distance);
    }

  private:
    const Skin* skin_;
    std::optional<Skin> moved_;
    Vec3f origin_;
    Eigen::Isometry3f toHead_ = Eigen::Isometry3f::Identity();
};

}  // namespace

Status measureRest(SceneHair hair, const HeadPose& pose, const SimulationOptions& options,
                   OtherErrors& errors) {
    runtime::SimulationSettings& settings = hair.groom.simulation;
    const float usual = runtime::SimulationSettings().dampingTime;
    settings.windSpeed = 0;
    settings.dampingTime = settings.dampingTime > 0 ? std::min(settings.dampingTime, usual) : usual;
    HeadPose still = inWorld(pose);
    still.wind_ws.reset();
    auto simulation = Simulation::make(hair.groom, still, options);
    if (!simulation) return tl::unexpected(simulation.error());
    const auto points = [&] {
        return std::vector<Vec3f>(simulation->positions_ws().begin(), simulation->positions_ws().end());
    };
    const std::vector<Vec3f> authored = points();
    const double first = letRest(*simulation, still);
    const std::vector<Vec3f> before = points();
    for (std::uint32_t frame = 1; frame <= kShakeFrames; ++frame)
        simulation->step(1 / kFramesPerSecond, shaken(still, frame));
    const double second = letRest(*simulation, still);
    const std::vector<Vec3f> after = points();
    if (!isFinite(before) || !isFinite(after)) {
        const double never = std::numeric_limits<double>::infinity();
        errors.dropMm = errors.returnMm = errors.restSpeed = never;
        return {};
    }
    errors.dropMm = rmsMm(before, authored);
    errors.returnMm = rmsMm(after, before);
    errors.restSpeed = std::max(first, second);
    return simulation->status();
}

std::vector<double> headDepths(const Groom& groom, std::span<const HeadPose> framePoses,
                               std::span<const Trajectory* const> trajectories) {
    std::vector<double> deepest(trajectories.size(), 0.0);
    if (!groom.scalp) return deepest;
    const Skin atRest(groom.scalp);
    // By frame, then by trajectory: the tree of a frame serves all of them.
    const std::size_t frames = framePoses.size() - 1;
    std::vector<float> depths(frames * trajectories.size(), 0.0f);
    parallelFor(frames, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t frame = begin; frame < end; ++frame) {
            const PosedHead head(atRest, framePoses[frame + 1]);
            for (std::size_t t = 0; t < trajectories.size(); ++t) {
                const Trajectory& run = *trajectories[t];
                if (!run.finite || run.points_ws.empty()) continue;
                const std::span points(run.points_ws.data() + frame * run.pointsPerFrame, run.pointsPerFrame);
                float& depth = depths[frame * trajectories.size() + t];
                for (const Vec3f& point : points) depth = std::max(depth, head.depthAt(point));
            }
        }
    });
    for (std::size_t i = 0; i < depths.size(); ++i) {
        double& of = deepest[i % trajectories.size()];
        of = std::max(of, 1e3 * static_cast<double>(depths[i]));
    }
    return deepest;
}

}  // namespace hairloom
