// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_character.h"

#include <fmt/format.h>

#include <algorithm>

#include "exporters/avatar_bones.h"
#include "exporters/character.h"

namespace hairloom {
namespace {

/// The bone that roots are bound to most, of all corners of their triangles; kNoBone where nothing moves
/// them.
std::uint32_t boneOfRoots(const Groom& groom, const ImportedScene& scene) {
    std::vector<double> shares(scene.skeleton.bones().size());
    if (scene.skin.vertexCount() != scene.mesh.vertexCount()) return kNoBone;
    for (const std::uint32_t triangle :
         groom.strandAttributes.view<std::uint32_t>(attribute::kRootTriangle)) {
        if (triangle >= scene.mesh.triangles().size()) continue;
        for (const std::uint32_t vertex : scene.mesh.triangles()[triangle]) {
            for (std::size_t i = 0; i < 4; ++i) {
                const float weight = scene.skin.weights[vertex][i];
                if (weight > 0) shares[scene.skin.bones[vertex][i]] += static_cast<double>(weight);
            }
        }
    }
    const auto most = std::ranges::max_element(shares);
    return most != shares.end() && *most > 0 ? static_cast<std::uint32_t>(most - shares.begin()) : kNoBone;
}

/// cardCharacter(), with the bones of a humanoid where they are asked for and there.
cards::Character characterWith(const Groom& groom, bool avatar, std::vector<Finding>& findings) {
    cards::Character character;
    const bool boned = std::ranges::any_of(groom.spheres, [](const auto& s) { return !s.bone.empty(); });
    const auto scene = characterOf(groom, findings);
    const auto missing = [&](const std::string& bone) {
        findings.push_back({Severity::Warning, fmt::format("the character has no bone '{}'", bone), "spheres",
                            "attach the sphere to another bone. It now moves with the head"});
    };
    if (!scene) {
        if (boned)
            findings.push_back({Severity::Warning, "collision spheres have bones, but there is no character",
                                "spheres", "export where the head file is. They now move with the head"});
        return character;
    }
    const std::uint32_t head = boneOfRoots(groom, *scene);
    if (head == kNoBone) return character;
    const std::vector<Bone>& bones = scene->skeleton.bones();
    std::vector<bool> needed(bones.size());
    const auto need = [&](std::uint32_t bone) {
        for (; bone != kNoBone && !needed[bone]; bone = bones[bone].parent) needed[bone] = true;
    };
    need(head);
    for (const CollisionSphere& sphere : groom.spheres) {
        if (sphere.bone.empty()) continue;
        const auto bone = scene->skeleton.find(sphere.bone);
        if (bone)
            need(*bone);
        else
            missing(sphere.bone);
    }
    const auto humanoid = avatar ? avatarBonesOf(scene->skeleton) : std::nullopt;
    if (humanoid) std::ranges::for_each(*humanoid, need);
    std::vector<std::int32_t> placeOf(bones.size(), -1);
    for (const std::uint32_t bone : scene->skeleton.order()) {
        if (!needed[bone]) continue;
        placeOf[bone] = static_cast<std::int32_t>(character.bones.size());
        const std::uint32_t parent = bones[bone].parent;
        character.bones.push_back(
            {bones[bone].name, parent == kNoBone ? -1 : placeOf[parent], bones[bone].inverseBind.inverse()});
    }
    character.head = placeOf[head];
    for (std::size_t b = 0; humanoid && b < kAvatarBones; ++b)
        character.humanoid.emplace_back(nameOf(static_cast<AvatarBone>(b)), placeOf[(*humanoid)[b]]);
    return character;
}

Vec3f middleOfRoots(const Groom& groom) {
    Vec3f middle = Vec3f::Zero();
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        middle += groom.strand(s)[0] / static_cast<float>(groom.strandCount());
    return middle;
}

}  // namespace

cards::Character cardCharacter(const Groom& groom, std::vector<Finding>& findings) {
    return characterWith(groom, false, findings);
}

cards::Character avatarCharacter(const Groom& groom, const std::string& name,
                                 std::vector<Finding>& findings) {
    cards::Character character = characterWith(groom, true, findings);
    if (character.humanoid.empty()) {
        // Roots lie around the upper half of a head, whose joint is at the base of the skull.
        constexpr float kBelowRoots = 0.12f;
        addAvatarBody(character, middleOfRoots(groom) - kBelowRoots * Vec3f::UnitY());
        findings.push_back(
            {Severity::Info,
             "the head file has no whole humanoid: bones of an adult's body were put below the "
             "head",
             "VRMC_vrm", "import a character with hips, spine, arms and legs"});
    }
    findings.push_back({Severity::Info, "author and licence are not named, and nothing is permitted yet",
                        "VRMC_vrm", "set them in the program that publishes the avatar"});
    character.name = name;
    return character;
}

}  // namespace hairloom
