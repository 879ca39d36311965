// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_character.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/base/parallel.h"
#include "core/geometry/closest_point.h"
#include "exporters/avatar_bones.h"
#include "exporters/character.h"

namespace hairloom {
namespace {

/// What the skin is moved by at the place on it that is nearest to each root, four bones at most; none where
/// nothing moves it.
SkinWeights skinOfRoots(const Groom& groom, const ImportedScene& scene, std::span<const Vec3f> roots_ws) {
    SkinWeights skin;
    if (scene.skin.vertexCount() != scene.mesh.vertexCount()) return skin;
    skin.bones.resize(roots_ws.size()), skin.weights.resize(roots_ws.size());
    const SurfaceTree tree(*groom.scalp, groom.scalpSelection);
    parallelFor(roots_ws.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            const SurfacePoint at = tree.closest(roots_ws[r]).surface;
            std::map<std::uint32_t, float> shares;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = scene.mesh.triangles()[at.triangle][corner];
                for (std::size_t k = 0; k < kBonesOfVertex; ++k) {
                    const float share =
                        at.barycentric[static_cast<int>(corner)] * scene.skin.weights[vertex][k];
                    if (share > 0) shares[scene.skin.bones[vertex][k]] += share;
                }
            }
            setStrongest(skin, r, {shares.begin(), shares.end()}, 4);
        }
    });
    return skin;
}

/// The bone that roots move with most; kNoBone where nothing moves them.
std::uint32_t boneOfMost(const SkinWeights& skin, std::size_t bones) {
    std::vector<double> shares(bones);
    for (std::size_t r = 0; r < skin.vertexCount(); ++r) {
        for (std::size_t k = 0; k < 4; ++k)
            shares[skin.bones[r][k]] += static_cast<double>(skin.weights[r][k]);
    }
    const auto most = std::ranges::max_element(shares);
    return most != shares.end() && *most > 0 ? static_cast<std::uint32_t>(most - shares.begin()) : kNoBone;
}

/// By the character's own numbers of bones. Roots that nothing moves go with the head.
std::vector<cards::Character::Root> rootsOf(const SkinWeights& skin, const std::vector<std::int32_t>& placeOf,
                                            std::int32_t head) {
    std::vector<cards::Character::Root> roots(skin.vertexCount());
    for (std::size_t r = 0; r < roots.size(); ++r) {
        roots[r].bones[0] = static_cast<std::uint16_t>(head);
        if (skin.weights[r][0] == 0) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = skin.weights[r][k];
            roots[r].weights[static_cast<int>(k)] = weight;
            roots[r].bones[k] =
                weight > 0 ? static_cast<std::uint16_t>(placeOf[skin.bones[r][k]]) : std::uint16_t{0};
        }
    }
    return roots;
}

/// cardCharacter(), with the bones of a humanoid where they are asked for and there.
cards::Character characterWith(const CardRoots& hair, bool avatar, std::vector<Finding>& findings) {
    const Groom& groom = hair.groom;
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
    const std::vector<Bone>& bones = scene->skeleton.bones();
    const SkinWeights skin = skinOfRoots(groom, *scene, hair.roots_ws);
    const std::uint32_t head = boneOfMost(skin, bones.size());
    if (head == kNoBone) return character;
    std::vector<bool> needed(bones.size());
    const auto need = [&](std::uint32_t bone) {
        for (; bone != kNoBone && !needed[bone]; bone = bones[bone].parent) needed[bone] = true;
    };
    need(head);
    for (std::size_t r = 0; r < skin.vertexCount(); ++r)
        for (std::size_t k = 0; k < 4; ++k)
            if (skin.weights[r][k] > 0) need(skin.bones[r][k]);
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
    character.roots = rootsOf(skin, placeOf, character.head);
    for (std::size_t b = 0; humanoid && b < kAvatarBones; ++b)
        character.humanoid.emplace_back(nameOf(static_cast<AvatarBone>(b)), placeOf[(*humanoid)[b]]);
    return character;
}

Vec3f middleOf(std::span<const Vec3f> roots_ws) {
    Vec3f middle = Vec3f::Zero();
    for (const Vec3f& root : roots_ws) middle += root / static_cast<float>(roots_ws.size());
    return middle;
}

}  // namespace

cards::Character cardCharacter(const CardRoots& hair, std::vector<Finding>& findings) {
    return characterWith(hair, false, findings);
}

cards::Character avatarCharacter(const CardRoots& hair, const std::string& name,
                                 std::vector<Finding>& findings) {
    cards::Character character = characterWith(hair, true, findings);
    if (character.humanoid.empty()) {
        // Roots lie around the upper half of a head, whose joint is at the base of the skull.
        constexpr float kBelowRoots = 0.12f;
        addAvatarBody(character, middleOf(hair.roots_ws) - kBelowRoots * Vec3f::UnitY());
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
