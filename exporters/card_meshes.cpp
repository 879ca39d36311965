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

std::string jointName(const Rig& rig, std::size_t joint) {
    if (joint == 0) return "head";
    return fmt::format("hair_{}_{}", (joint - 1) / rig.perChain, (joint - 1) % rig.perChain);
}

CardMesh cardMeshOf(std::string name, const Level& level, LevelArrays arrays) {
    CardMesh mesh;
    mesh.name = std::move(name);
    mesh.material = level.name;
    mesh.positions_ws = std::move(arrays.positions_ws);
    mesh.normals_ws = std::move(arrays.normals_ws);
    mesh.colours = std::move(arrays.colours);
    mesh.uvs = std::move(arrays.uvs);
    for (const auto& joints : arrays.joints) std::ranges::copy(joints, mesh.joints.emplace_back().begin());
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
                                 const std::filesystem::path& path) {
    SceneAndTextures made;
    made.scene.format = format;
    made.scene.stem = path.stem().string();
    for (const Level& level : chain.levels) {
        if (level.spec.kind == cards::LevelKind::strands) continue;
        LevelArrays arrays = cards::arraysOf(level, chain.rig);
        auto textures = cards::textureFilesOf(level, arrays, made.scene.stem);
        if (!textures) return tl::unexpected(textures.error());
        for (auto& [beside, bytes] : textures->files)
            made.textures.emplace_back(path.parent_path() / beside, std::move(bytes));
        // Unity makes a group of levels of names that end so.
        std::string name = fmt::format("{}_LOD{}", level.name, made.scene.meshes.size());
        CardMesh& mesh =
            made.scene.meshes.emplace_back(cardMeshOf(std::move(name), level, std::move(arrays)));
        mesh.colourFile = textures->colour;
        mesh.normalFile = textures->normal;
    }
    for (std::size_t j = 0; j < chain.rig.joints.size(); ++j) {
        const cards::Joint& joint = chain.rig.joints[j];
        made.scene.joints.push_back({jointName(chain.rig, j), joint.parent, joint.position_ws});
    }
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
                                                 const std::filesystem::path& path) {
    const auto isStrands = [](const Level& level) { return level.spec.kind == cards::LevelKind::strands; };
    if (std::ranges::all_of(chain.levels, isStrands))
        return fail("no level that a mesh can hold", "one of cards or a shell");
    auto made = sceneOf(chain, format, path);
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
