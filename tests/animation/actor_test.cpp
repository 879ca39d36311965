// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/actor.h"

#include <gtest/gtest.h>

namespace hairloom {
namespace {

/// Two triangles: one on a hip that never moves, one on a head that turns a quarter about Y through (0, 1, 0)
/// and rises by 1 m over one second.
class ActorTest : public testing::Test {
  protected:
    void SetUp() override {
        PolygonSoup soup;
        soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {1, 1, 0}, {0, 1, -1}};
        soup.corners = {0, 1, 2, 3, 4, 5};
        soup.offsets = {0, 3, 6};
        auto mesh = ScalpMesh::make(soup);
        ASSERT_TRUE(mesh) << mesh.error().message();
        Bone hip, head;
        hip.name = "hip";
        head.name = "head";
        head.parent = 0;
        head.rest = Eigen::Affine3f(Eigen::Translation3f(0, 1, 0));
        head.inverseBind = Eigen::Affine3f(Eigen::Translation3f(0, -1, 0));
        Channel turn;
        turn.bone = 1;
        turn.translation = {{0.0f, 1.0f}, {{0, 1, 0}, {0, 2, 0}}};
        turn.rotation = {{0.0f, 1.0f},
                         {Quatf::Identity(), Quatf(Eigen::AngleAxisf(kPi / 2, Vec3f::UnitY()))}};
        SkinWeights skin;
        for (const std::uint32_t source : mesh->sourceVertices()) {
            skin.bones.push_back({source < 3 ? 0u : 1u, 0, 0, 0});
            skin.weights.push_back({1, 0, 0, 0});
        }
        shared = std::make_shared<const ScalpMesh>(std::move(*mesh));
        auto made = Actor::make(shared, Skeleton::make({hip, head}).value(), {{"turn", 1.0f, {turn}}}, skin);
        ASSERT_TRUE(made) << made.error().message();
        actor = std::move(*made);
        for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
            SurfacePoint& root = shared->pointAt(triangle, {1, 0, 0}).y() > 0.5f ? headRoot : hipRoot;
            root.triangle = triangle;
            root.barycentric = Vec3f(0.2f, 0.3f, 0.5f);
        }
    }
    static Vec3f expectedOnHead(const Vec3f& rest) {
        return Eigen::AngleAxisf(kPi / 2, Vec3f::UnitY()) * (rest - Vec3f(0, 1, 0)) + Vec3f(0, 2, 0);
    }

    std::shared_ptr<const ScalpMesh> shared;
    Actor actor;
    SurfacePoint headRoot, hipRoot;
};

TEST_F(ActorTest, RestPoseIsTheMesh) {
    const ActorPose pose = actor.restPose();
    for (std::size_t vertex = 0; vertex < shared->vertexCount(); ++vertex) {
        EXPECT_LT((pose.positions_ws[vertex] - shared->positions()[vertex]).norm(), 1e-6f);
    }
}

TEST_F(ActorTest, VerticesSpheresAndRootsFollowTheirBones) {
    const ActorPose pose = actor.poseAt(0, 1.0f, Wrap::Clamp);
    for (std::size_t vertex = 0; vertex < shared->vertexCount(); ++vertex) {
        const Vec3f& rest = shared->positions()[vertex];
        const Vec3f expected = rest.y() > 0.5f ? expectedOnHead(rest) : rest;
        EXPECT_LT((pose.positions_ws[vertex] - expected).norm(), 1e-5f);
    }
    const std::vector<CollisionSphere> spheres{{"skull", {0.5f, 1.2f, 0}, 0.1f, "head"},
                                               {"box", {0, 0, 0}, 0.1f, ""}};
    const auto transforms = actor.sphereTransforms(spheres, pose);
    EXPECT_LT((transforms[0] * spheres[0].centre - expectedOnHead(spheres[0].centre)).norm(), 1e-5f);
    EXPECT_TRUE(transforms[1].matrix().isIdentity());

    const std::vector<SurfacePoint> roots{headRoot, hipRoot};
    const auto moved = actor.rootTransforms(roots, pose);
    const Vec3f tip = shared->pointAt(headRoot.triangle, headRoot.barycentric) + Vec3f(0.1f, 0.3f, 0.2f);
    EXPECT_LT((moved[0] * tip - expectedOnHead(tip)).norm(), 1e-5f);
    EXPECT_TRUE(moved[1].isApprox(Eigen::Isometry3f::Identity(), 1e-6f));
}

TEST_F(ActorTest, PlacementMovesEverythingRigidly) {
    const Eigen::Isometry3f placement =
        Eigen::Translation3f(3, -1, 2) * Eigen::AngleAxisf(0.8f, Vec3f::UnitZ());
    const ActorPose before = actor.poseAt(0, 0.5f, Wrap::Clamp);
    actor.setPlacement(placement);
    const ActorPose after = actor.poseAt(0, 0.5f, Wrap::Clamp);
    for (std::size_t vertex = 0; vertex < shared->vertexCount(); ++vertex) {
        EXPECT_LT((after.positions_ws[vertex] - placement * before.positions_ws[vertex]).norm(), 1e-5f);
    }
    const std::vector<SurfacePoint> roots{hipRoot};
    EXPECT_TRUE(actor.rootTransforms(roots, after)[0].isApprox(placement, 1e-5f));
    const std::vector<CollisionSphere> loose{{"s", {0, 0, 0}, 0.1f, "no such bone"}};
    EXPECT_TRUE(actor.sphereTransforms(loose, after)[0].matrix().isApprox(placement.matrix()));
}

TEST_F(ActorTest, RefusesWeightsThatDoNotFitAndNamesItsClips) {
    EXPECT_FALSE(Actor::make(shared, {}, {}, SkinWeights{{{}}, {{}}}));
    EXPECT_TRUE(Actor::make(shared, {}, {}, {})) << "a statue is fine";
    EXPECT_EQ(actor.findClip("turn").value(), 0u);
    const auto missing = actor.findClip("run");
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message().find("expected one of 'turn'"), std::string::npos);
}

}  // namespace
}  // namespace hairloom
