// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recorded motion of bones and of morph targets.

#include <span>
#include <string>
#include <vector>

#include "core/animation/morphs.h"
#include "core/animation/skeleton.h"

namespace hairloom {

/// Values at times. Times are seconds, strictly ascending; both arrays are equally long.
template <class T>
struct Track {
    std::vector<float> times;
    std::vector<T> values;
};

/// The motion of one bone relative to its parent: scaled, then rotated, then moved. A bone with a channel
/// leaves its rest transform wholly; a track without keys stands for no movement, no rotation or scale one.
struct Channel {
    std::uint32_t bone = 0;
    Track<Vec3f> translation;  ///< metres
    Track<Quatf> rotation;     ///< unit length
    Track<Vec3f> scale;        ///< factors
};

/// The weight of a morph target, in place of its weight of rest.
struct MorphChannel {
    std::uint32_t target = 0;  ///< index among those of the mesh
    Track<float> weight;       ///< has keys; 0 none of it, 1 all
};

struct Clip {
    std::string name;
    float duration = 0;  ///< seconds, ≥ 0
    std::vector<Channel> channels = {};
    std::vector<MorphChannel> morphs = {};
};

/// What holds outside [0, duration].
enum class Wrap { Clamp, Loop };

/// Errors: a channel for a bone that the skeleton lacks, or for a morph target beyond `morphTargets`; tracks
/// of unequal arrays, times that do not ascend, values that are not finite, a rotation of length zero, a
/// weight without keys.
Status validate(const Clip& clip, const Skeleton& skeleton, std::size_t morphTargets = 0);

/// Linear between keys, the end keys' values outside them; `empty` where there are none.
Vec3f sample(const Track<Vec3f>& track, float time, const Vec3f& empty);
/// Spherical linear along the shorter arc (Shoemake 1985); the identity where there are no keys.
Quatf sample(const Track<Quatf>& track, float time);
/// Linear between keys, the end keys' values outside them; 0 where there are none.
float sample(const Track<float>& track, float time);

/// From each bone's space to its parent's at `time` seconds; bones without a channel rest.
std::vector<Eigen::Affine3f> localMatrices(const Skeleton& skeleton, const Clip& clip, float time, Wrap wrap);
/// At rest.
std::vector<Eigen::Affine3f> localMatrices(const Skeleton& skeleton);

/// Of each target at `time` seconds; targets without a channel have their weights of rest. Empty where the
/// clip moves none.
std::vector<float> morphWeights(std::span<const MorphTarget> targets, const Clip& clip, float time,
                                Wrap wrap);

/// Bone by bone, `share` 0 … 1 of the way: rotations along the shorter arc, places and scales linear.
std::vector<Eigen::Affine3f> blended(std::span<const Eigen::Affine3f> from,
                                     std::span<const Eigen::Affine3f> to, float share);

/// From the mesh's rest space to the world, per bone: world matrix × inverse bind matrix.
std::vector<Eigen::Affine3f> skinMatrices(const Skeleton& skeleton, std::span<const Eigen::Affine3f> local);

}  // namespace hairloom
