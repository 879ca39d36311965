// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <span>
#include <system_error>

#include "core/cards/level_arrays.h"
#include "exporters/card_mesh_scene.h"
#include "importers/answer_stream.h"
#include "importers/child_process.h"
#include "importers/reader_limits.h"

namespace hairloom {
namespace {

using cards::Level;
using cards::LevelArrays;
using cards::Rig;

std::string jointName(const Rig& rig, std::size_t joint, const char* root) {
    if (joint == 0) return root;
    return fmt::format("hair_{}_{}", (joint - 1) / rig.perChain, (joint - 1) % rig.perChain);
}

/// The character's bones come first, for joints of the rig hang on them.
std::vector<CardJoint> jointsOf(const cards::Chain& chain, const cards::Character& character) {
    std::vector<CardJoint> joints;
    for (const cards::Character::Bone& bone : character.bones) {
        const auto& place = bone.bind_ws;
        joints.push_back({bone.name, bone.parent, place.translation(), place.linear().col(0),
                          place.linear().col(1), place.linear().col(2)});
    }
    const Rig& rig = chain.rig;
    const std::vector<std::int32_t> ofChains = cards::bonesOfChains(chain, character);
    const auto first = static_cast<std::int32_t>(joints.size());
    const bool isBoned = character.head >= 0;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        CardJoint joint{jointName(rig, j, isBoned ? "hair" : "head"), -1, rig.joints[j].position_ws};
        if (rig.joints[j].parent >= 0) joint.parent = first + rig.joints[j].parent;
        if (isBoned && j == 0) joint.parent = character.head;
        if (isBoned && j > 0 && (j - 1) % rig.perChain == 0) {
            const std::int32_t bone = ofChains[(j - 1) / rig.perChain];
            if (bone != character.head) joint.parent = bone;
        }
        joints.push_back(std::move(joint));
    }
    return joints;
}

/// `rig`: of how many joints, behind which the arrays number `bones`.
CardMesh cardMeshOf(std::string name, const Level& level, LevelArrays arrays, std::size_t rig,
                    std::size_t bones) {
    CardMesh mesh;
    mesh.name = std::move(name);
    mesh.material = level.name;
    mesh.positions_ws = std::move(arrays.positions_ws);
    mesh.normals_ws = std::move(arrays.normals_ws);
    mesh.colours = std::move(arrays.colours);
    mesh.uvs = std::move(arrays.uvs);
    for (const auto& joints : arrays.joints)
        std::ranges::transform(joints, mesh.joints.emplace_back().begin(), [&](std::uint16_t joint) {
            return static_cast<std::uint32_t>(joint < rig ? bones + joint : joint - rig);
        });
    for (const Vec4f& weights : arrays.weights)
        mesh.weights.push_back({weights[0], weights[1], weights[2], weights[3]});
    mesh.indices = std::move(arrays.indices);
    return mesh;
}

struct SceneAndTextures {
    CardMeshScene scene;
    CardFiles textures;
};

Result<SceneAndTextures> sceneOf(const cards::Chain& chain, CardMeshFormat format,
                                 const std::filesystem::path& path, const cards::Character& character,
                                 cards::Cancel cancel) {
    SceneAndTextures made;
    made.scene.format = format;
    made.scene.stem = path.stem().string();
    for (const Level& level : chain.levels) {
        if (level.spec.kind == cards::LevelKind::strands) continue;
        LevelArrays arrays = cards::arraysOf(level, chain.rig);
        cards::hangOnBones(level, chain, character, arrays);
        auto textures = cards::textureFilesOf(level, arrays, made.scene.stem, cancel);
        if (!textures) return tl::unexpected(textures.error());
        for (auto& [beside, bytes] : textures->files)
            made.textures.emplace_back(path.parent_path() / beside, std::move(bytes));
        // Unity makes a group of levels of names that end so.
        std::string name = fmt::format("{}_LOD{}", level.name, made.scene.meshes.size());
        CardMesh& mesh = made.scene.meshes.emplace_back(cardMeshOf(
            std::move(name), level, std::move(arrays), chain.rig.joints.size(), character.bones.size()));
        mesh.colourFile = textures->colour;
        mesh.normalFile = textures->normal;
    }
    made.scene.joints = jointsOf(chain, character);
    return made;
}

/// What hairloom-mesh-writer makes of the scene.
Result<std::vector<WrittenMeshFile>> filesOf(const CardMeshScene& scene, const std::filesystem::path& path) {
    std::vector<std::byte> input;
    writeAnswer(
        Result<CardMeshScene>(scene), AnswerKind::CardScene, "",
        [&](std::span<const std::byte> piece) { input.insert(input.end(), piece.begin(), piece.end()); },
        kCardSceneMembers);
    const auto program = programFolder() / "hairloom-mesh-writer";
    if (std::error_code code; !std::filesystem::exists(program, code))
        return failIn(path.string(), {}, "cannot be written without the mesh writer",
                      "expected the program " + program.string());
    auto answer = runChild("the mesh writer", program, {}, limitsOfFile(input.size()), input);
    if (!answer) {
        Error error = inFile(answer.error(), path.string());
        error.expected = "nothing was written";
        return tl::unexpected(error);
    }
    std::string lacking;
    return readAnswer<std::vector<WrittenMeshFile>>(path.string(), *answer, AnswerKind::MeshFiles, lacking,
                                                    kMeshFilesMembers);
}

}  // namespace

Result<std::vector<std::string>> writeCardMeshes(const cards::Chain& chain, CardMeshFormat format,
                                                 const std::filesystem::path& path,
                                                 const cards::Character& character, cards::Cancel cancel) {
    const auto isStrands = [](const Level& level) { return level.spec.kind == cards::LevelKind::strands; };
    if (std::ranges::all_of(chain.levels, isStrands))
        return fail("no level that a mesh can hold", "one of cards or a shell");
    auto made = sceneOf(chain, format, path, character, cancel);
    if (!made) return tl::unexpected(made.error());
    const auto files = filesOf(made->scene, path);
    if (!files) return tl::unexpected(files.error());
    CardFiles written;
    for (const auto& [name, text] : *files) {
        std::vector<std::byte> bytes(text.size());
        std::memcpy(bytes.data(), text.data(), text.size());
        written.emplace_back(written.empty() ? path : path.parent_path() / name, std::move(bytes));
    }
    std::ranges::move(made->textures, std::back_inserter(written));
    return writeTogether(written);
}

}  // namespace hairloom
