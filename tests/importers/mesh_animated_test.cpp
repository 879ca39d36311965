// SPDX-License-Identifier: GPL-3.0-or-later
// Skins and clips of real characters, against the deformed mesh that another program wrote.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/animation/actor.h"
#include "importers/scene.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

const std::filesystem::path kAnimated = outsideData() / "animated";

Actor actorOf(ImportedScene scene) {
    auto mesh = std::make_shared<const ScalpMesh>(std::move(scene.mesh));
    return Actor::make(mesh, std::move(scene.skeleton), std::move(scene.clips), std::move(scene.skin))
        .value();
}

/// The largest distance from a posed vertex to the true vertices.
float farthest(std::span<const Vec3f> posed, std::span<const Vec3f> groundTruth) {
    float worst = 0;
    for (const Vec3f& vertex : posed) {
        float nearest = (vertex - groundTruth.front()).norm();
        for (const Vec3f& other : groundTruth) nearest = std::min(nearest, (vertex - other).norm());
        worst = std::max(worst, nearest);
    }
    return worst;
}

TEST(MeshAnimated, SkinnedFbxMatchesTheDeformedMeshOfItsAuthor) {
    const auto file = kAnimated / "ufbx_blender_279_sausage_7400_binary.fbx";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no data beside this checkout: " << file;
    auto scene = importScene(file);
    ASSERT_TRUE(scene) << scene.error().message();
    const auto spin = importScene(kAnimated / "ufbx_blender_279_sausage_spin_15.obj");
    const auto base = importScene(kAnimated / "ufbx_blender_279_sausage_base_0.obj");
    ASSERT_TRUE(spin && base);
    EXPECT_LT(farthest(scene->mesh.positions(), base->mesh.positions()), 1e-5f) << "the bind pose";
    const Actor actor = actorOf(std::move(*scene));
    const auto clip = actor.findClip("Skeleton|Spin");
    ASSERT_TRUE(clip) << clip.error().message();
    const ActorPose pose = actor.poseAt(*clip, 15.0f / 24.0f, Wrap::Clamp);
    ASSERT_EQ(pose.positions_ws.size(), spin->mesh.vertexCount());
    EXPECT_LT(farthest(pose.positions_ws, spin->mesh.positions()), 1e-5f);
    EXPECT_LT(farthest(spin->mesh.positions(), pose.positions_ws), 1e-5f);
    const ActorPose other = actor.poseAt(*clip, 14.0f / 24.0f, Wrap::Clamp);
    EXPECT_GT(farthest(other.positions_ws, spin->mesh.positions()), 1e-2f) << "another frame is another pose";
}

struct Character {
    const char* file;
    std::size_t clips;
    const char* bone;
};

void PrintTo(const Character& printed, std::ostream* out) {
    *out << printed.file;
}

class MeshCharacter : public testing::TestWithParam<Character> {};

TEST_P(MeshCharacter, EveryClipSamplesFinite) {
    const auto file = kAnimated / GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no data beside this checkout: " << file;
    auto scene = importScene(file);
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->format, "glb");
    EXPECT_EQ(scene->metresPerUnit, 1.0f);
    EXPECT_EQ(scene->skin.vertexCount(), scene->mesh.vertexCount());
    const float size = scene->mesh.bounds().sizes().maxCoeff();
    const Actor actor = actorOf(std::move(*scene));
    EXPECT_EQ(actor.clips().size(), GetParam().clips);
    EXPECT_TRUE(actor.skeleton().find(GetParam().bone));
    for (std::uint32_t clip = 0; clip < actor.clips().size(); ++clip) {
        EXPECT_GT(actor.clips()[clip].duration, 0.0f);
        for (int step = -2; step <= 12; ++step) {
            const float time = 0.1f * static_cast<float>(step) * actor.clips()[clip].duration;
            const ActorPose pose = actor.poseAt(clip, time, Wrap::Loop);
            for (const Vec3f& position : pose.positions_ws) {
                ASSERT_TRUE(position.allFinite()) << actor.clips()[clip].name << " at " << time;
                ASSERT_LT(position.norm(), 10 * size) << actor.clips()[clip].name << " at " << time;
            }
            for (const Vec3f& normal : pose.normals_ws) ASSERT_NEAR(normal.norm(), 1.0f, 1e-3f);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Glb, MeshCharacter,
                         testing::Values(Character{"raylib_robot.glb", 14, "Neck"},
                                         Character{"raylib_greenman.glb", 4, "body_up"},
                                         Character{"CesiumMan.glb", 1, "Skeleton_neck_joint_2"}));

TEST(MeshAnimated, BindPoseOfACharacterIsItsRestPose) {
    for (const char* name : {"CesiumMan.glb", "raylib_robot.glb"}) {
        const auto file = kAnimated / name;
        if (!std::filesystem::exists(file)) GTEST_SKIP() << "no data beside this checkout: " << file;
        const Actor actor = actorOf(importScene(file).value());
        const ActorPose pose = actor.restPose();
        float worst = 0;
        for (std::size_t vertex = 0; vertex < pose.positions_ws.size(); ++vertex) {
            worst = std::max(worst, (pose.positions_ws[vertex] - actor.mesh().positions()[vertex]).norm());
        }
        EXPECT_LT(worst, 1e-4f) << name;
    }
}

}  // namespace
}  // namespace hairloom
