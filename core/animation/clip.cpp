// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hairloom {
namespace {

bool finite(const Vec3f& value) {
    return value.allFinite();
}
bool finite(float value) {
    return std::isfinite(value);
}
bool finite(const Quatf& value) {
    return value.coeffs().allFinite() && value.squaredNorm() > 0;
}

template <class T>
Status validateTrack(const Track<T>& track, const std::string& where) {
    if (track.times.size() != track.values.size()) {
        return fail(
            fmt::format("{}: {} times for {} values", where, track.times.size(), track.values.size()));
    }
    for (std::size_t key = 0; key < track.times.size(); ++key) {
        if (!std::isfinite(track.times[key]) || !finite(track.values[key])) {
            return fail(fmt::format("{}: key {} is not finite or has no length", where, key));
        }
        if (key > 0 && track.times[key] <= track.times[key - 1]) {
            return fail(fmt::format("{}: key {} at {} s does not come after {} s", where, key,
                                    track.times[key], track.times[key - 1]),
                        "expected ascending times");
        }
    }
    return {};
}

/// The keys before and after a time, and how far it is between them.
struct Between {
    std::size_t first;
    std::size_t second;
    float fraction;
};

Between locate(const std::vector<float>& times, float time) {
    const auto after = std::ranges::upper_bound(times, time);
    if (after == times.begin()) return {0, 0, 0.0f};
    const auto second = static_cast<std::size_t>(after - times.begin());
    if (second == times.size()) return {second - 1, second - 1, 0.0f};
    const float span = times[second] - times[second - 1];
    return {second - 1, second, (time - times[second - 1]) / span};
}

float wrapped(float time, float duration, Wrap wrap) {
    if (duration <= 0) return 0;
    if (wrap == Wrap::Clamp) return std::clamp(time, 0.0f, duration);
    const float rest = std::fmod(time, duration);
    return rest < 0 ? rest + duration : rest;
}

}  // namespace

Status validate(const Clip& clip, const Skeleton& skeleton, std::size_t morphTargets) {
    if (!std::isfinite(clip.duration) || clip.duration < 0) {
        return fail(fmt::format("clip '{}' lasts {} s", clip.name, clip.duration), "expected a duration ≥ 0");
    }
    for (const Channel& channel : clip.channels) {
        if (channel.bone >= skeleton.bones().size()) {
            return fail(fmt::format("clip '{}' moves bone {}", clip.name, channel.bone),
                        fmt::format("there are {} bones", skeleton.bones().size()));
        }
        const std::string where =
            fmt::format("clip '{}', bone '{}'", clip.name, skeleton.bones()[channel.bone].name);
        if (auto status = validateTrack(channel.translation, where + ", translation"); !status) return status;
        if (auto status = validateTrack(channel.rotation, where + ", rotation"); !status) return status;
        if (auto status = validateTrack(channel.scale, where + ", scale"); !status) return status;
    }
    for (const MorphChannel& channel : clip.morphs) {
        if (channel.target >= morphTargets)
            return fail(fmt::format("clip '{}' moves morph target {}", clip.name, channel.target),
                        fmt::format("there are {} targets", morphTargets));
        const std::string where = fmt::format("clip '{}', morph target {}", clip.name, channel.target);
        if (channel.weight.times.empty()) return fail(where + " has no keys", "expected at least one");
        if (auto status = validateTrack(channel.weight, where); !status) return status;
    }
    return {};
}

Vec3f sample(const Track<Vec3f>& track, float time, const Vec3f& empty) {
    if (track.times.empty()) return empty;
    const Between at = locate(track.times, time);
    return track.values[at.first] + at.fraction * (track.values[at.second] - track.values[at.first]);
}

Quatf sample(const Track<Quatf>& track, float time) {
    if (track.times.empty()) return Quatf::Identity();
    const Between at = locate(track.times, time);
    return track.values[at.first].slerp(at.fraction, track.values[at.second]).normalized();
}

float sample(const Track<float>& track, float time) {
    if (track.times.empty()) return 0;
    const Between at = locate(track.times, time);
    return track.values[at.first] + at.fraction * (track.values[at.second] - track.values[at.first]);
}

std::vector<Eigen::Affine3f> localMatrices(const Skeleton& skeleton) {
    std::vector<Eigen::Affine3f> local;
    local.reserve(skeleton.bones().size());
    for (const Bone& bone : skeleton.bones()) local.push_back(bone.rest);
    return local;
}

std::vector<Eigen::Affine3f> localMatrices(const Skeleton& skeleton, const Clip& clip, float time,
                                           Wrap wrap) {
    std::vector<Eigen::Affine3f> local = localMatrices(skeleton);
    const float at = wrapped(time, clip.duration, wrap);
    for (const Channel& channel : clip.channels) {
        local[channel.bone] = Eigen::Translation3f(sample(channel.translation, at, Vec3f::Zero())) *
                              sample(channel.rotation, at) *
                              Eigen::Scaling(sample(channel.scale, at, Vec3f::Ones()));
    }
    return local;
}

std::vector<float> morphWeights(std::span<const MorphTarget> targets, const Clip& clip, float time,
                                Wrap wrap) {
    std::vector<float> weights;
    if (clip.morphs.empty()) return weights;
    for (const MorphTarget& target : targets) weights.push_back(target.restWeight);
    const float at = wrapped(time, clip.duration, wrap);
    for (const MorphChannel& channel : clip.morphs) weights[channel.target] = sample(channel.weight, at);
    return weights;
}

std::vector<Eigen::Affine3f> blended(std::span<const Eigen::Affine3f> from,
                                     std::span<const Eigen::Affine3f> to, float share) {
    assert(from.size() == to.size());
    std::vector<Eigen::Affine3f> result(from.begin(), from.end());
    for (std::size_t bone = 0; bone < from.size(); ++bone) {
        if (from[bone].matrix() == to[bone].matrix()) continue;
        Eigen::Matrix3f rotationFrom, rotationTo, scaleFrom, scaleTo;
        from[bone].computeRotationScaling(&rotationFrom, &scaleFrom);
        to[bone].computeRotationScaling(&rotationTo, &scaleTo);
        const Vec3f place =
            from[bone].translation() + share * (to[bone].translation() - from[bone].translation());
        const Quatf rotation = Quatf(rotationFrom).slerp(share, Quatf(rotationTo)).normalized();
        result[bone].translation() = place;
        result[bone].linear() = rotation.toRotationMatrix() * (scaleFrom + share * (scaleTo - scaleFrom));
    }
    return result;
}

std::vector<Eigen::Affine3f> skinMatrices(const Skeleton& skeleton, std::span<const Eigen::Affine3f> local) {
    std::vector<Eigen::Affine3f> matrices = skeleton.worldMatrices(local);
    for (std::size_t bone = 0; bone < matrices.size(); ++bone) {
        matrices[bone] = matrices[bone] * skeleton.bones()[bone].inverseBind;
    }
    return matrices;
}

}  // namespace hairloom
