// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/scene_run.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/geometry/curve.h"
#include "core/groom/poses.h"
#include "core/groom/strand_subset.h"
#include "core/interpolation/strand_follow.h"

namespace hairloom {
namespace {

/// `count` of 0 … total − 1, ascending (the first steps of Fisher and Yates's shuffle).
std::vector<std::uint32_t> drawn(std::size_t total, std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> all(total);
    std::iota(all.begin(), all.end(), 0u);
    if (count >= total) return all;
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        std::swap(all[i], all[i + random.below(static_cast<std::uint32_t>(total - i))]);
    }
    all.resize(count);
    std::ranges::sort(all);
    return all;
}

/// Shares of the polyline's length at its points; evenly spread where it has no length.
void appendShares(std::span<const Vec3f> strand, std::vector<float>& shares) {
    const double whole = static_cast<double>(polylineLength(strand));
    double length = 0;
    for (std::size_t i = 0; i < strand.size(); ++i) {
        if (i > 0) length += static_cast<double>((strand[i] - strand[i - 1]).norm());
        const double even = static_cast<double>(i) / static_cast<double>(strand.size() - 1);
        shares.push_back(static_cast<float>(whole > 0 ? std::min(length / whole, 1.0) : even));
    }
}

/// Hairs that are made frame after frame, for their time.
class TimedFollowers {
  public:
    static Result<TimedFollowers> make(const StrandFollow& follow) {
        auto made = runtime::FollowHairs::make(follow.view());
        if (!made.hairs) return tl::unexpected(errorOfWords(made.error));
        return TimedFollowers(std::move(*made.hairs));
    }

    void follow(std::span<const Vec3f> guides_ws) {
        runtime::GuideMotion motion;
        motion.positions_ws = {reinterpret_cast<const runtime::Float3*>(guides_ws.data()), guides_ws.size()};
        runtime::Host host;
        host.parallelFor = parallelFor;
        const Stopwatch watch;
        hairs_.evaluate(motion, positions_ws_, host);
        milliseconds_ += 1e3 * watch.seconds();
    }
    double milliseconds() const { return milliseconds_; }

  private:
    explicit TimedFollowers(runtime::FollowHairs hairs)
        : hairs_(std::move(hairs)), positions_ws_(std::size_t{hairs_.hairCount()} * hairs_.pointsPerHair()) {}

    runtime::FollowHairs hairs_;
    std::vector<runtime::Float3> positions_ws_;
    double milliseconds_ = 0;
};

}  // namespace

std::vector<std::uint32_t> drawnStrands(const Groom& groom, std::size_t count, std::uint64_t seed) {
    return drawn(groom.strandCount(), count, seed);
}

MaterialPoints::MaterialPoints(const SceneHair& hair, const Followed& followed) {
    for (const std::uint32_t s : followed.strands) {
        const std::uint32_t first = hair.groom.offsets[s], last = hair.groom.offsets[s + 1] - 1;
        std::uint32_t from = first;
        for (const float share : followed.shares) {
            while (from + 1 < last && hair.arcShares[from + 1] < share) ++from;
            const float length = hair.arcShares[from + 1] - hair.arcShares[from];
            const float t = length > 0 ? (share - hair.arcShares[from]) / length : 0;
            places_.push_back({from, std::clamp(t, 0.0f, 1.0f)});
        }
    }
}

bool MaterialPoints::read(std::span<const Vec3f> positions_ws, std::vector<Vec3f>& into_ws) const {
    bool finite = true;
    for (const Place& place : places_) {
        const Vec3f& from = positions_ws[place.from];
        into_ws.push_back(from + place.t * (positions_ws[place.from + 1] - from));
        finite = finite && into_ws.back().allFinite();
    }
    return finite;
}

SceneHair sampleStrands(const Groom& groom, std::size_t count, std::uint64_t seed) {
    const std::vector<std::uint32_t> strands = drawnStrands(groom, count, seed);
    SceneHair hair{strandsOf(groom, strands), {}};
    for (const std::uint32_t strand : strands) appendShares(groom.strand(strand), hair.arcShares);
    return hair;
}

SceneHair strandsOf(const SceneHair& hair, std::span<const std::uint32_t> strands) {
    SceneHair some{strandsOf(hair.groom, strands), {}};
    for (const std::uint32_t s : strands) {
        const auto shares = hair.arcShares.begin();
        some.arcShares.insert(some.arcShares.end(), shares + hair.groom.offsets[s],
                              shares + hair.groom.offsets[s + 1]);
    }
    return some;
}

SceneHair resampledHair(const SceneHair& hair, std::uint32_t points) {
    assert(points >= 2);
    SceneHair result;
    result.groom = hair.groom;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::size_t s = 0; s < hair.groom.strandCount(); ++s) {
        const std::vector<Vec3f> even = resampleEvenly(hair.groom.strand(s), points);
        positions.insert(positions.end(), even.begin(), even.end());
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        for (std::uint32_t i = 0; i < points; ++i) {
            result.arcShares.push_back(static_cast<float>(i) / static_cast<float>(points - 1));
        }
    }
    result.groom.offsets = CowArray<std::uint32_t>(std::move(offsets));
    result.groom.pointAttributes = AttributeSet();
    result.groom.operators.clear();  // their base shape has other points
    for (const GroomPose& pose : hair.groom.poses) {
        const auto shape = hair.groom.pointAttributes.view<Vec3f>(poseAttribute(pose.name));
        if (shape.size() != hair.groom.pointCount()) continue;
        std::vector<Vec3f> posed;
        for (std::size_t s = 0; s < hair.groom.strandCount(); ++s) {
            const std::size_t first = hair.groom.offsets[s];
            const std::vector<Vec3f> even =
                resampleEvenly(shape.subspan(first, hair.groom.offsets[s + 1] - first), points);
            posed.insert(posed.end(), even.begin(), even.end());
        }
        result.groom.pointAttributes.set(poseAttribute(pose.name), std::move(posed));
    }
    result.groom.pointAttributes.set(attribute::kPosition, std::move(positions));
    return result;
}

std::uint32_t maxPoints(const Groom& groom) {
    std::size_t maximum = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) maximum = std::max(maximum, groom.strand(s).size());
    return static_cast<std::uint32_t>(maximum);
}

std::vector<HeadPose> posesOf(const HeadMotion& motion, const SceneTime& time) {
    std::vector<HeadPose> poses;
    const std::uint32_t posesPerFrame = time.stepsPerFrame * (time.posesWithin + 1);
    const float posesPerSecond = time.framesPerSecond * static_cast<float>(posesPerFrame);
    for (std::uint32_t pose = 0; pose <= time.frames * posesPerFrame; ++pose) {
        poses.push_back(motion.poseAt(static_cast<float>(pose) / posesPerSecond));
    }
    return poses;
}

std::vector<HeadPose> framePosesOf(std::span<const HeadPose> poses, const SceneTime& time) {
    std::vector<HeadPose> ofFrames;
    for (std::size_t frame = 0; frame <= time.frames; ++frame)
        ofFrames.push_back(poses[frame * time.stepsPerFrame * (time.posesWithin + 1)]);
    return ofFrames;
}

std::vector<float> evenShares(std::uint32_t count) {
    std::vector<float> shares;
    for (std::uint32_t i = 1; i <= count; ++i) {
        shares.push_back(static_cast<float>(i) / static_cast<float>(count));
    }
    return shares;
}

TrajectoryError compare(const Trajectory& run, const Trajectory& groundTruth) {
    assert(run.points_ws.size() == groundTruth.points_ws.size() && run.finite && groundTruth.finite);
    double sum = 0, largest = 0;
    for (std::size_t i = 0; i < run.points_ws.size(); ++i) {
        const double squared =
            (run.points_ws[i].cast<double>() - groundTruth.points_ws[i].cast<double>()).squaredNorm();
        sum += squared;
        largest = std::max(largest, squared);
    }
    const double count = static_cast<double>(std::max<std::size_t>(run.points_ws.size(), 1));
    return {1e3 * std::sqrt(sum / count), 1e3 * std::sqrt(largest)};
}

Result<SceneResult> runScene(const SceneHair& hair, std::span<const HeadPose> poses, const SceneTime& time,
                             const Followed& followed, const SimulationOptions& options,
                             const StrandFollow* followers) {
    const std::size_t posesPerStep = time.posesWithin + 1;
    assert(poses.size() == std::size_t{time.frames} * time.stepsPerFrame * posesPerStep + 1);
    auto simulation = Simulation::make(hair.groom, poses[0], options);
    if (!simulation) return tl::unexpected(simulation.error());
    const MaterialPoints points(hair, followed);
    std::optional<TimedFollowers> following;
    if (followers) {
        auto made = TimedFollowers::make(*followers);
        if (!made) return tl::unexpected(made.error());
        following.emplace(std::move(*made));
    }
    SceneResult result;
    Trajectory& trajectory = result.trajectory;
    trajectory.frames = time.frames;
    trajectory.pointsPerFrame = points.count();
    trajectory.points_ws.reserve(points.count() * time.frames);
    const float dt = 1.0f / (time.framesPerSecond * static_cast<float>(time.stepsPerFrame));
    for (std::uint32_t frame = 0; frame < time.frames && trajectory.finite; ++frame) {
        for (std::uint32_t step = 1; step <= time.stepsPerFrame; ++step) {
            const std::size_t end = (std::size_t{frame} * time.stepsPerFrame + step) * posesPerStep;
            auto within = poses.subspan(end - time.posesWithin, time.seesWithin ? time.posesWithin : 0);
            if (staysThrough(poses[end - posesPerStep], within, poses[end])) within = {};
            simulation->step(dt, poses[end], within);
        }
        if (following) following->follow(simulation->positions_ws());
        trajectory.finite = points.read(simulation->positions_ws(), trajectory.points_ws);
    }
    const SimulationStats stats = simulation->stats();
    result.millisecondsPerFrame = stats.millisecondsPerFrame * static_cast<double>(time.stepsPerFrame);
    if (following) result.millisecondsPerFrame += following->milliseconds() / time.frames;
    result.stateHash = stats.stateHash;
    result.nanCount = stats.nanCount;
    result.restoredStrands = stats.restoredStrands;
    result.sphereDepthMm = stats.maxPenetrationMm;
    result.effects = stats.effects;
    return result;
}

}  // namespace hairloom
