// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_format.h"

#include <gmock/gmock.h>

#include "importers/raw_scene_stream.h"
#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

std::optional<MeshFormat> formatOf(const std::string& content) {
    return meshFormatOf(std::as_bytes(std::span(content)), content.size());
}

TEST(MeshFormat, IsFoundFromContent) {
    EXPECT_EQ(formatOf("# made by hand\n\nv 0 0 0\n"), MeshFormat::Obj);
    EXPECT_EQ(formatOf("mtllib a.mtl\n"), MeshFormat::Obj);
    EXPECT_EQ(formatOf("ply\r\nformat ascii 1.0\r\n"), MeshFormat::Ply);
    EXPECT_EQ(formatOf("solid cube\n facet normal 0 0 1\n"), MeshFormat::Stl);
    EXPECT_EQ(formatOf(std::string("solid binary").append(68, ' ').append({1, 0, 0, 0}).append(50, '\0')),
              MeshFormat::Stl);
    EXPECT_EQ(formatOf(std::string("Kaydara FBX Binary  ") + std::string({0, 0x1a})), MeshFormat::Fbx);
    EXPECT_EQ(formatOf("; FBX 7.4.0 project file\n"), MeshFormat::Fbx);
    EXPECT_EQ(formatOf(std::string("glTF") + std::string({2, 0, 0, 0})), MeshFormat::Glb);
    EXPECT_EQ(formatOf(" {\"asset\": {}}"), MeshFormat::Gltf);
    EXPECT_EQ(formatOf("<COLLADA>\nv 1 2 3\n"), std::nullopt);
    EXPECT_EQ(formatOf("v for victory\n"), std::nullopt);
    EXPECT_EQ(formatOf(""), std::nullopt);
}

using SceneFile = MeshFiles;

TEST_F(SceneFile, OtherFormatsAreRefusedNamingThoseThatAreRead) {
    EXPECT_THAT(refusal("mesh.obj", "OFF\n3 1 0\n"),
                HasSubstr("expected a mesh in OBJ, PLY, STL, FBX, glTF, GLB, USD or Alembic"));
    EXPECT_THAT(importScene(folder / "none.obj").error().message(), HasSubstr("no such file"));
    EXPECT_THAT(importScene(folder).error().message(), HasSubstr("is not a regular file"));
}

constexpr std::string_view kStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n";

TEST_F(SceneFile, TheNameOfTheFilePlaysNoPart) {
    const auto stl = import("cube.glb", kStl);
    ASSERT_TRUE(stl) << stl.error().message();
    EXPECT_EQ(stl->format, "stl");
    EXPECT_EQ(stl->mesh.triangleCount(), 1u);
}

TEST_F(SceneFile, NamesInAnyScriptReachTheReader) {
    const std::filesystem::path path = folder / u8"Haarschöpfe 髪.stl";
    ASSERT_TRUE(writeFileAtomically(path, kStl));
    const auto stl = importScene(path);
    ASSERT_TRUE(stl) << stl.error().message();
    EXPECT_EQ(stl->mesh.triangleCount(), 1u);
    const std::filesystem::path damaged = folder / u8"Müll ü 髪.stl";
    ASSERT_TRUE(writeFileAtomically(damaged, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 zero"));
    const auto refused = importScene(damaged);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("Müll ü 髪.stl"));
}

RawScene everything() {
    RawScene scene;
    scene.soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.soup.offsets = {0, 3};
    scene.soup.corners = {0, 1, 2};
    scene.soup.uvs = {{0, 0}, {1, 0}, {0, 1}};
    scene.soup.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    scene.soup.faceGroups = {0};
    scene.soup.groupNames = {"head"};
    Bone bone;
    bone.name = "neck";
    bone.rest = Eigen::Affine3f(Eigen::Translation3f(1, 2, 3));
    scene.bones = {bone};
    Channel channel;
    channel.rotation = {{0.0f, 1.0f}, {Quatf::Identity(), Quatf(0, 1, 0, 0)}};
    scene.clips = {{"nod", 1.0f, {channel}}};
    scene.clips[0].morphs = {{1, {{0, 0.5f}, {0, 1}}}};
    scene.morphs = {{"brow", 0, {1}, {{0, 0, 1}}}, {"jaw", 0.25f, {0, 2}, {{0, -1, 0}, {0, -2, 0}}}};
    scene.skin.bones = {{}, {}, {}};
    scene.skin.weights = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    scene.warnings = {"a warning"};
    scene.metresPerUnit = 0.01f;
    return scene;
}

std::vector<std::byte> answerOf(const Result<RawScene>& scene) {
    std::vector<std::byte> bytes;
    writeRawScene(scene, "", [&](std::span<const std::byte> piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
    });
    return bytes;
}

TEST(RawSceneStream, ReadsBackWhatWasWritten) {
    const RawScene scene = everything();
    std::string lacking;
    const auto back = readRawScene("x.fbx", answerOf(scene), lacking);
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_TRUE(validate(*back));
    EXPECT_EQ(back->soup.positions, scene.soup.positions);
    EXPECT_EQ(back->soup.uvs, scene.soup.uvs);
    EXPECT_EQ(back->soup.groupNames, scene.soup.groupNames);
    EXPECT_EQ(back->bones[0].rest.matrix(), scene.bones[0].rest.matrix());
    EXPECT_EQ(back->clips[0].channels[0].rotation.values[1].coeffs(), Quatf(0, 1, 0, 0).coeffs());
    EXPECT_EQ(back->skin.weights, scene.skin.weights);
    ASSERT_EQ(back->morphs.size(), 2u);
    EXPECT_EQ(back->morphs[1].name, "jaw");
    EXPECT_EQ(back->morphs[1].restWeight, 0.25f);
    EXPECT_EQ(back->morphs[1].vertices, scene.morphs[1].vertices);
    EXPECT_EQ(back->morphs[1].offsets, scene.morphs[1].offsets);
    EXPECT_EQ(back->clips[0].morphs[0].target, 1u);
    EXPECT_EQ(back->clips[0].morphs[0].weight.values, scene.clips[0].morphs[0].weight.values);
    EXPECT_EQ(back->metresPerUnit, 0.01f);
    const auto error = readRawScene("x.fbx", answerOf(failIn("", Line{7}, "broken", "whole")), lacking);
    ASSERT_FALSE(error);
    EXPECT_EQ(error.error().message(), "x.fbx:7: broken; whole");
}

TEST(RawSceneStream, EveryTruncationAndEveryDamagedByteIsHandled) {
    const std::vector<std::byte> bytes = answerOf(everything());
    std::string lacking;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        EXPECT_FALSE(readRawScene("x.fbx", std::span(bytes).first(length), lacking)) << length;
    }
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::vector<std::byte> damaged = bytes;
        damaged[at] ^= std::byte{0xff};
        const auto scene = readRawScene("x.fbx", damaged, lacking);
        if (scene) std::ignore = validate(*scene);
    }
}

TEST(RawScene, ValidationRefusesWhatDoesNotFit) {
    const auto problem = [](const auto& damage) {
        RawScene scene = everything();
        damage(scene);
        const auto status = validate(scene);
        EXPECT_FALSE(status);
        return status ? std::string() : status.error().message();
    };
    EXPECT_TRUE(validate(everything()));
    EXPECT_THAT(problem([](RawScene& s) { s.soup.corners[1] = 3; }), HasSubstr("face 0 refers to vertex 3"));
    EXPECT_THAT(problem([](RawScene& s) { s.soup.offsets = {0}; }), HasSubstr("no faces"));
    EXPECT_THAT(problem([](RawScene& s) { s.soup.offsets = {0, 9, 3}; }), HasSubstr("corner ranges"));
    EXPECT_THAT(problem([](RawScene& s) { s.soup.positions[2].x() = std::nanf(""); }),
                HasSubstr("not a finite"));
    EXPECT_THAT(problem([](RawScene& s) { s.soup.faceGroups = {1}; }), HasSubstr("face 0 is in group 1"));
    EXPECT_THAT(problem([](RawScene& s) { s.soup.uvs.pop_back(); }), HasSubstr("texture coordinates"));
    EXPECT_THAT(problem([](RawScene& s) { s.bones[0].parent = 0; }), HasSubstr("form a cycle"));
    EXPECT_THAT(problem([](RawScene& s) { s.skin.bones[1][0] = 4; }), HasSubstr("vertex 1 follows bone 4"));
    EXPECT_THAT(problem([](RawScene& s) { s.clips[0].channels[0].bone = 1; }), HasSubstr("moves bone 1"));
    EXPECT_THAT(problem([](RawScene& s) { s.clips[0].morphs[0].target = 2; }),
                HasSubstr("moves morph target 2"));
    EXPECT_THAT(problem([](RawScene& s) { s.morphs[1].vertices[0] = 3; }), HasSubstr("moves vertex 3"));
    EXPECT_THAT(problem([](RawScene& s) { s.morphs[0].offsets.pop_back(); }),
                HasSubstr("0 offsets for 1 vertices"));
    EXPECT_THAT(problem([](RawScene& s) { s.morphs[0].offsets[0].x() = std::nanf(""); }),
                HasSubstr("not finite"));
}

TEST(RawScene, ScalingLengthsLeavesAnglesAlone) {
    RawScene scene = everything();
    scaleLengths(scene, 2.0f);
    EXPECT_EQ(scene.soup.positions[1], Vec3f(2, 0, 0));
    EXPECT_EQ(scene.bones[0].rest.translation(), Vec3f(2, 4, 6));
    EXPECT_TRUE(scene.bones[0].rest.linear().isIdentity());
    EXPECT_EQ(scene.morphs[1].offsets[1], Vec3f(0, -4, 0));
    EXPECT_EQ(scene.morphs[1].restWeight, 0.25f);
}

}  // namespace
}  // namespace hairloom::test
