// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/point_cache.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "importers/scene_parts.h"

namespace hairloom {
namespace {

/// Of the mesh's extent: what rounding makes of points that stay.
constexpr double kStill = 1e-6;

Eigen::Isometry3d weightedMotion(std::span<const Vec3f> from, std::span<const Vec3f> to,
                                 const std::vector<double>& weights) {
    Vec3d centre = Vec3d::Zero(), gone = Vec3d::Zero();
    double sum = 0;
    for (std::size_t p = 0; p < from.size(); ++p) {
        centre += weights[p] * from[p].cast<double>();
        gone += weights[p] * to[p].cast<double>();
        sum += weights[p];
    }
    centre /= sum;
    gone /= sum;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t p = 0; p < from.size(); ++p)
        spread += weights[p] * (to[p].cast<double>() - gone) * (from[p].cast<double>() - centre).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> parts(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3d signs = Vec3d::Ones();
    if ((parts.matrixU() * parts.matrixV().transpose()).determinant() < 0) signs.z() = -1;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = parts.matrixU() * signs.asDiagonal() * parts.matrixV().transpose();
    motion.translation() = gone - motion.linear() * centre;
    return motion;
}

double extentOf(std::span<const Vec3f> points) {
    Box3f box;
    for (const Vec3f& point : points) box.extend(point);
    return box.isEmpty() ? 0 : static_cast<double>(box.sizes().maxCoeff());
}

/// The samples that are read, `every` so many, and the last. Times that are one in single precision are one.
std::vector<std::size_t> samplesOf(const PointCache::Mesh& mesh, std::size_t every) {
    std::vector<std::size_t> samples;
    const auto take = [&](std::size_t s) {
        const bool isLater = samples.empty() || mesh.seconds[s] > mesh.seconds[samples.back()];
        if (isLater && std::isfinite(mesh.seconds[s])) samples.push_back(s);
    };
    for (std::size_t s = 0; s < mesh.seconds.size(); s += every) take(s);
    take(mesh.seconds.size() - 1);
    return samples;
}

/// 1 at one of the times, 0 at those beside it.
Track<float> tentAt(const std::vector<float>& times, std::size_t at) {
    Track<float> track;
    const std::size_t from = at == 0 ? 0 : at - 1, to = std::min(at + 1, times.size() - 1);
    for (std::size_t t = from; t <= to; ++t) {
        track.times.push_back(times[t]);
        track.values.push_back(t == at ? 1.0f : 0.0f);
    }
    return track;
}

/// The rigid motion that brings most of `from` nearest to `to`, which are equally many: points that go
/// elsewhere, as a jaw's, count for less (iteratively reweighted least squares after Kabsch 1976).
Eigen::Isometry3d motionOfMost(std::span<const Vec3f> from, std::span<const Vec3f> to) {
    constexpr int kTurns = 10;
    std::vector<double> weights(from.size(), 1.0), away(from.size()), sorted;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const double least = kStill * extentOf(from) + 1e-12;
    for (int turn = 0; turn < kTurns; ++turn) {
        motion = weightedMotion(from, to, weights);
        for (std::size_t p = 0; p < from.size(); ++p)
            away[p] = (motion * from[p].cast<double>() - to[p].cast<double>()).norm();
        sorted = away;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::ranges::nth_element(sorted, middle);
        const double usual = std::max(*middle, least);
        for (std::size_t p = 0; p < from.size(); ++p)
            weights[p] = 1 / (1 + (away[p] / usual) * (away[p] / usual));
    }
    return motion;
}

}  // namespace

void PointCache::add(Mesh mesh) {
    if (mesh.seconds.size() > 1 && mesh.points > 0) meshes_.push_back(std::move(mesh));
}

Status PointCache::finish(Clip& clip) {
    std::uint64_t all = 0;
    for (const Mesh& mesh : meshes_) all += std::uint64_t{mesh.points} * mesh.seconds.size();
    const std::size_t every = static_cast<std::size_t>((all + kMostCached - 1) / kMostCached);
    if (every > 1)
        scene_.warnings.push_back(
            fmt::format("meshes have {} points at all of their times, and {} are read: each {}. time is", all,
                        kMostCached, every));
    for (const Mesh& mesh : meshes_) {
        if (auto status = play(mesh, std::max<std::size_t>(every, 1), clip); !status) return status;
    }
    meshes_.clear();
    return {};
}

Status PointCache::play(const Mesh& mesh, std::size_t every, Clip& clip) {
    const std::vector<std::size_t> samples = samplesOf(mesh, every);
    if (samples.size() < 2) return {};
    const auto rest = std::span<const Vec3f>(scene_.soup.positions).subspan(mesh.first, mesh.points);
    const double still = kStill * extentOf(rest);
    std::vector<float> times;
    for (const std::size_t s : samples) times.push_back(mesh.seconds[s]);
    const auto stay = [&](std::size_t sample, const std::string& why) -> Status {
        scene_.warnings.push_back(fmt::format("{}: at {:.3g} s {}; its points stay as they are at first",
                                              mesh.name, static_cast<double>(mesh.seconds[sample]), why));
        return {};
    };
    Channel whole;
    std::vector<MorphTarget> targets;
    std::vector<MorphChannel> channels;
    bool isMoved = false;
    std::size_t moved = moved_;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const auto points = mesh.read(samples[k]);
        if (!points) return tl::unexpected(points.error());
        if (points->size() != rest.size())
            return stay(samples[k],
                        fmt::format("it has {} points instead of {}", points->size(), rest.size()));
        if (!std::ranges::all_of(*points, [](const Vec3f& point) { return point.allFinite(); }))
            return stay(samples[k], "it has points that are no numbers");
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        if (!mesh.isCarried) motion = motionOfMost(rest, *points);
        whole.translation.values.push_back(motion.translation().cast<float>());
        whole.rotation.values.push_back(
            Quatf(Eigen::Quaterniond(motion.linear()).cast<float>()).normalized());
        const Eigen::Isometry3d back = motion.inverse();
        MorphTarget target;
        target.name = fmt::format("{} {}", mesh.name, samples[k]);
        for (std::uint32_t p = 0; p < mesh.points; ++p) {
            const Vec3d offset = back * (*points)[p].cast<double>() - rest[p].cast<double>();
            if (!(offset.norm() > still)) continue;
            target.vertices.push_back(mesh.first + p);
            target.offsets.push_back(offset.cast<float>());
        }
        isMoved = isMoved || std::ranges::any_of(rest, [&](const Vec3f& p) {
                      return (motion * p.cast<double>() - p.cast<double>()).norm() > still;
                  });
        if (target.vertices.empty()) continue;
        moved += target.vertices.size();
        if (moved > kMostCached)
            return stay(samples[k], fmt::format("all meshes move more than {} points", kMostCached));
        channels.push_back(
            {static_cast<std::uint32_t>(scene_.morphs.size() + targets.size()), tentAt(times, k)});
        targets.push_back(std::move(target));
    }
    moved_ = moved;
    std::ranges::move(targets, std::back_inserter(scene_.morphs));
    std::ranges::move(channels, std::back_inserter(clip.morphs));
    clip.duration = std::max(clip.duration, times.back());
    if (!isMoved) return {};
    whole.translation.times = whole.rotation.times = times;
    const auto own = static_cast<std::uint32_t>(scene_.bones.size());
    whole.bone = own;
    Bone bone;
    bone.name = mesh.name;
    scene_.bones.push_back(std::move(bone));
    clip.channels.push_back(std::move(whole));
    for (std::uint32_t p = mesh.first; p < mesh.first + mesh.points; ++p) {
        scene_.skin.bones[p] = {own};
        scene_.skin.weights[p] = {1.0f};
    }
    return {};
}

}  // namespace hairloom
