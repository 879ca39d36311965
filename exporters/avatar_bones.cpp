// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/avatar_bones.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace hairloom {
namespace {

struct Known {
    std::string_view name;  ///< VRM's, which Unity's is, too
    std::int32_t parent;    ///< of AvatarBone, that it hangs on, however many lie between; -1: none
    std::array<std::string_view, 5> others;  ///< as shortened() has them
    Vec3f fromHead;                          ///< metres, of an adult who stretches the arms out
};
const std::array<Known, kAvatarBones>& known() {
    static const std::array<Known, kAvatarBones> all{{
        {"hips", -1, {"pelvis", "hip"}, {0, -0.68f, 0}},
        {"spine", 0, {"spine1", "spine01", "spine05", "abdomen"}, {0, -0.56f, 0}},
        {"head", 1, {"spine006"}, {0, 0, 0}},
        {"leftUpperLeg",
         0,
         {"leftupleg", "lupperleg", "thighl", "upperlegl", "upperleg01l"},
         {0.09f, -0.76f, 0}},
        {"leftLowerLeg",
         3,
         {"leftleg", "llowerleg", "shinl", "lowerlegl", "lowerleg01l"},
         {0.09f, -1.16f, 0}},
        {"leftFoot", 4, {"lfoot", "footl"}, {0.09f, -1.55f, 0}},
        {"rightUpperLeg",
         0,
         {"rightupleg", "rupperleg", "thighr", "upperlegr", "upperleg01r"},
         {-0.09f, -0.76f, 0}},
        {"rightLowerLeg",
         6,
         {"rightleg", "rlowerleg", "shinr", "lowerlegr", "lowerleg01r"},
         {-0.09f, -1.16f, 0}},
        {"rightFoot", 7, {"rfoot", "footr"}, {-0.09f, -1.55f, 0}},
        {"leftUpperArm", 1, {"leftarm", "lupperarm", "upperarml", "upperarm01l"}, {0.17f, -0.2f, 0}},
        {"leftLowerArm",
         9,
         {"leftforearm", "llowerarm", "forearml", "lowerarml", "lowerarm01l"},
         {0.44f, -0.2f, 0}},
        {"leftHand", 10, {"lhand", "handl", "wristl"}, {0.69f, -0.2f, 0}},
        {"rightUpperArm", 1, {"rightarm", "rupperarm", "upperarmr", "upperarm01r"}, {-0.17f, -0.2f, 0}},
        {"rightLowerArm",
         12,
         {"rightforearm", "rlowerarm", "forearmr", "lowerarmr", "lowerarm01r"},
         {-0.44f, -0.2f, 0}},
        {"rightHand", 13, {"rhand", "handr", "wristr"}, {-0.69f, -0.2f, 0}},
    }};
    return all;
}

/// Letters and digits alone, small, without what tools put before.
std::string shortened(std::string_view name) {
    std::string text;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const std::string_view prefix : {"mixamorig", "jbipc", "jbip", "def"}) {
        if (text.starts_with(prefix) && text.size() > prefix.size()) return text.substr(prefix.size());
    }
    return text;
}

bool hangsOn(const Skeleton& skeleton, std::uint32_t bone, std::uint32_t above) {
    for (bone = skeleton.bones()[bone].parent; bone != kNoBone; bone = skeleton.bones()[bone].parent)
        if (bone == above) return true;
    return false;
}

}  // namespace

std::string_view nameOf(AvatarBone bone) {
    return known()[static_cast<std::size_t>(bone)].name;
}

std::optional<std::array<std::uint32_t, kAvatarBones>> avatarBonesOf(const Skeleton& skeleton) {
    std::vector<std::string> names;
    for (const Bone& bone : skeleton.bones()) names.push_back(shortened(bone.name));
    const auto find = [&](std::string_view name) {
        const auto at = name.empty() ? names.end() : std::ranges::find(names, name);
        return at == names.end() ? kNoBone : static_cast<std::uint32_t>(at - names.begin());
    };
    std::array<std::uint32_t, kAvatarBones> found;
    for (std::size_t b = 0; b < kAvatarBones; ++b) {
        found[b] = find(shortened(known()[b].name));
        for (const std::string_view other : known()[b].others)
            if (found[b] == kNoBone) found[b] = find(other);
        if (found[b] == kNoBone) return std::nullopt;
        const std::int32_t parent = known()[b].parent;
        if (parent >= 0 && !hangsOn(skeleton, found[b], found[static_cast<std::size_t>(parent)]))
            return std::nullopt;
    }
    return found;
}

void addAvatarBody(cards::Character& character, const Vec3f& head_ws) {
    cards::Character avatar;
    const bool hasHead = character.head >= 0;
    const Vec3f at_ws =
        hasHead ? Vec3f(character.bones[static_cast<std::size_t>(character.head)].bind_ws.translation())
                : head_ws;
    std::array<std::int32_t, kAvatarBones> place{};
    constexpr auto kHead = static_cast<std::size_t>(AvatarBone::head);
    for (std::size_t b = 0; b < kAvatarBones; ++b) {
        if (b == kHead && hasHead) continue;
        place[b] = static_cast<std::int32_t>(avatar.bones.size());
        const std::int32_t parent = known()[b].parent;
        avatar.bones.push_back({std::string(known()[b].name),
                                parent < 0 ? -1 : place[static_cast<std::size_t>(parent)],
                                Eigen::Affine3f(Eigen::Translation3f(at_ws + known()[b].fromHead))});
    }
    // What the character has itself hangs on the spine.
    const auto first = static_cast<std::int32_t>(avatar.bones.size());
    for (cards::Character::Bone& bone : character.bones) {
        bone.parent =
            bone.parent < 0 ? place[static_cast<std::size_t>(AvatarBone::spine)] : first + bone.parent;
        avatar.bones.push_back(std::move(bone));
    }
    avatar.roots = std::move(character.roots);
    for (cards::Character::Root& root : avatar.roots)
        for (std::uint16_t& bone : root.bones)
            bone = static_cast<std::uint16_t>(bone + static_cast<std::uint16_t>(first));
    avatar.head = hasHead ? first + character.head : place[kHead];
    place[kHead] = avatar.head;
    for (std::size_t b = 0; b < kAvatarBones; ++b) avatar.humanoid.emplace_back(known()[b].name, place[b]);
    character = std::move(avatar);
}

}  // namespace hairloom
