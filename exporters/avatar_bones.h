// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which bones of a character are those of a VRM 1.0 humanoid.

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "core/animation/skeleton.h"
#include "core/cards/glb.h"

namespace hairloom {

/// Every VRM 1.0 avatar has these.
enum class AvatarBone {
    hips,
    spine,
    head,
    leftUpperLeg,
    leftLowerLeg,
    leftFoot,
    rightUpperLeg,
    rightLowerLeg,
    rightFoot,
    leftUpperArm,
    leftLowerArm,
    leftHand,
    rightUpperArm,
    rightLowerArm,
    rightHand
};
inline constexpr std::size_t kAvatarBones = 15;
/// "leftUpperArm", as VRM has it.
std::string_view nameOf(AvatarBone bone);

/// Bones of the skeleton by the names of VRM, Unity, Mixamo, VRoid, Blender's Rigify and MakeHuman, by
/// AvatarBone. Nothing where one is missing or they do not hang together as VRM has them.
std::optional<std::array<std::uint32_t, kAvatarBones>> avatarBonesOf(const Skeleton& skeleton);

/// Puts a body of an adult below the head of a character that has none, joint by joint without a mesh, and
/// what the character has behind its spine. Sets Character::humanoid. Without bones: a head at `head_ws`.
void addAvatarBody(cards::Character& character, const Vec3f& head_ws);

}  // namespace hairloom
