// SPDX-License-Identifier: GPL-3.0-or-later
// A humanoid is found by the names that tools give its bones.
#include "exporters/avatar_bones.h"

#include <gtest/gtest.h>

#include <string>

namespace hairloom {
namespace {

/// Bones by name and the number of the bone that they hang on.
Skeleton skeletonOf(const std::vector<std::pair<std::string, int>>& named) {
    std::vector<Bone> bones;
    for (const auto& [name, parent] : named) {
        Bone bone;
        bone.name = name;
        bone.parent = parent < 0 ? kNoBone : static_cast<std::uint32_t>(parent);
        bones.push_back(bone);
    }
    return *Skeleton::make(std::move(bones));
}

std::vector<std::pair<std::string, int>> mixamo() {
    const auto name = [](const char* of) { return std::string("mixamorig:") + of; };
    return {{name("Hips"), -1},         {name("Spine"), 0},          {name("Spine1"), 1},
            {name("Neck"), 2},          {name("Head"), 3},           {name("LeftUpLeg"), 0},
            {name("LeftLeg"), 5},       {name("LeftFoot"), 6},       {name("RightUpLeg"), 0},
            {name("RightLeg"), 8},      {name("RightFoot"), 9},      {name("LeftShoulder"), 2},
            {name("LeftArm"), 11},      {name("LeftForeArm"), 12},   {name("LeftHand"), 13},
            {name("RightShoulder"), 2}, {name("RightArm"), 15},      {name("RightForeArm"), 16},
            {name("RightHand"), 17},    {name("RightHandIndex"), 18}};
}

TEST(AvatarBones, AreFoundByTheNamesOfTools) {
    const auto found = avatarBonesOf(skeletonOf(mixamo()));
    ASSERT_TRUE(found);
    EXPECT_EQ((*found)[static_cast<std::size_t>(AvatarBone::head)], 4u);
    EXPECT_EQ((*found)[static_cast<std::size_t>(AvatarBone::leftUpperArm)], 12u);
    EXPECT_EQ((*found)[static_cast<std::size_t>(AvatarBone::rightFoot)], 10u);
    std::vector<std::pair<std::string, int>> vroid = mixamo();
    const char* const names[] = {"C_Hips",     "C_Spine",    "C_Chest",    "C_Neck",     "C_Head",
                                 "L_UpperLeg", "L_LowerLeg", "L_Foot",     "R_UpperLeg", "R_LowerLeg",
                                 "R_Foot",     "L_Shoulder", "L_UpperArm", "L_LowerArm", "L_Hand",
                                 "R_Shoulder", "R_UpperArm", "R_LowerArm", "R_Hand",     "R_Index1"};
    for (std::size_t b = 0; b < vroid.size(); ++b) vroid[b].first = std::string("J_Bip_") + names[b];
    EXPECT_EQ(avatarBonesOf(skeletonOf(vroid)), found);
    for (std::size_t b = 0; b < vroid.size(); ++b)
        vroid[b].first = b == 0 ? "pelvis" : mixamo()[b].first.substr(10);
    EXPECT_EQ(avatarBonesOf(skeletonOf(vroid)), found);
}

TEST(AvatarBones, AreNoneWhereOneIsMissingOrHangsElsewhere) {
    EXPECT_FALSE(avatarBonesOf(Skeleton()));
    for (std::size_t b = 0; b < 19; ++b) {
        auto without = mixamo();
        const std::string name = without[b].first;
        if (name.ends_with("Spine1") || name.ends_with("Neck") || name.ends_with("Shoulder")) continue;
        without[b].first = "tail";
        // Another bone of the spine is one, too.
        EXPECT_EQ(avatarBonesOf(skeletonOf(without)).has_value(), name.ends_with(":Spine")) << name;
    }
    auto apart = mixamo();
    apart[13].second = -1;
    EXPECT_FALSE(avatarBonesOf(skeletonOf(apart))) << "a forearm that hangs on nothing";
}

TEST(AvatarBones, ABodyIsPutBelowAHead) {
    for (const bool hasHead : {false, true}) {
        cards::Character character;
        const Eigen::Affine3f head(Eigen::Translation3f(0.1f, 2, 0) * Eigen::AngleAxisf(1, Vec3f::UnitX()));
        if (hasHead) {
            character.bones = {{"root", -1, Eigen::Affine3f::Identity()}, {"Head", 0, head}};
            character.head = 1;
        }
        addAvatarBody(character, Vec3f(0.1f, 2, 0));
        ASSERT_EQ(character.humanoid.size(), kAvatarBones);
        for (std::size_t b = 0; b < character.bones.size(); ++b)
            EXPECT_LT(character.bones[b].parent, static_cast<int>(b)) << "parents before children";
        const auto of = [&](AvatarBone bone) {
            return static_cast<std::size_t>(character.humanoid[static_cast<std::size_t>(bone)].second);
        };
        EXPECT_EQ(static_cast<int>(of(AvatarBone::head)), character.head);
        EXPECT_EQ(character.bones[of(AvatarBone::head)].name, hasHead ? "Head" : "head");
        EXPECT_LT(character.bones[of(AvatarBone::hips)].bind_ws.translation().y(), 1.4f);
        EXPECT_GT(character.bones[of(AvatarBone::leftHand)].bind_ws.translation().x(),
                  character.bones[of(AvatarBone::rightHand)].bind_ws.translation().x() + 1);
        // The head hangs on the spine, over whatever lies between.
        bool below = false;
        for (int b = character.head; b >= 0; b = character.bones[static_cast<std::size_t>(b)].parent)
            below = below || b == static_cast<int>(of(AvatarBone::spine));
        EXPECT_TRUE(below);
    }
}

}  // namespace
}  // namespace hairloom
