// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The skeleton of the bust (root, neck, head), its skin weights and its clip.

#include <array>
#include <vector>

#include "core/base/math.h"

namespace hairloom::bust {

inline constexpr int kBoneCount = 3;

struct Bone {
    const char* name;
    int parent;      ///< -1 for the root
    Vec3d position;  ///< in the rest pose, metres; bones are not turned there
};

/// Parents before children.
const std::array<Bone, kBoneCount>& bones();

/// Share of each bone at a point of the surface; they add up to 1. The scalp belongs to the head alone.
Vec3d skinWeights(const Vec3d& p);

inline constexpr const char* kClipName = "nod_and_turn";
inline constexpr int kClipFrames = 61;  ///< 30 a second; the last equals the first
inline constexpr double kClipRate = 30.0;

/// Rotation of a bone against its parent at a frame: turn left, turn right, nod, at rest at both ends.
Eigen::Quaterniond boneRotation(int bone, int frame);

}  // namespace hairloom::bust
