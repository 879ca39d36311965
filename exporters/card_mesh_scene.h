// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hairloom-mesh-writer is given, and what it gives back, as importers/answer_stream.h has values.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "exporters/card_meshes.h"

namespace hairloom {

/// A level of cards or a shell. Metres, Y up. One entry a vertex, but indices, three a triangle.
struct CardMesh {
    std::string name, material;
    std::string colourFile, normalFile;  ///< as the file names them; empty where there is no texture
    std::vector<Vec3f> positions_ws, normals_ws, colours;
    std::vector<Vec2f> uvs;  ///< v from the upper edge down; empty where there is no texture
    std::vector<std::array<std::uint32_t, 4>> joints;
    std::vector<std::array<float, 4>> weights;
    std::vector<std::uint32_t> indices;
};

struct CardJoint {
    std::string name;
    std::int32_t parent = -1;  ///< comes before; -1: none
    /// Where it is at rest, and where its axes point, as long as its scale.
    Vec3f position_ws = Vec3f::Zero(), x_ws = Vec3f::UnitX(), y_ws = Vec3f::UnitY(), z_ws = Vec3f::UnitZ();
};

struct CardMeshScene {
    CardMeshFormat format = CardMeshFormat::obj;
    std::string stem;  ///< of the file's name
    std::vector<CardMesh> meshes;
    std::vector<CardJoint> joints;
};
inline constexpr auto kCardSceneMembers = [](auto& archive, auto& scene) {
    archive.choice(scene.format, CardMeshFormat::fbx);
    archive(scene.stem);
    archive.each(scene.meshes, [&](auto& mesh) {
        archive(mesh.name);
        archive(mesh.material);
        archive(mesh.colourFile);
        archive(mesh.normalFile);
        archive(mesh.positions_ws);
        archive(mesh.normals_ws);
        archive(mesh.colours);
        archive(mesh.uvs);
        archive(mesh.joints);
        archive(mesh.weights);
        archive(mesh.indices);
    });
    archive.each(scene.joints, [&](auto& joint) {
        archive(joint.name);
        archive(joint.parent);
        archive(joint.position_ws);
        archive(joint.x_ws);
        archive(joint.y_ws);
        archive(joint.z_ws);
    });
};

/// The first is the file itself; the others lie beside it.
struct WrittenMeshFile {
    std::string name, bytes;
};
inline constexpr auto kMeshFilesMembers = [](auto& archive, auto& files) {
    archive.each(files, [&](auto& file) {
        archive(file.name);
        archive(file.bytes);
    });
};

}  // namespace hairloom
