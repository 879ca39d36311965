// SPDX-License-Identifier: GPL-3.0-or-later
// Morph targets: what they do to vertices and normals, beside bones and between clips.

#include "core/animation/morphs.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/animation/actor.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MorphTarget target(std::string name, std::vector<std::uint32_t> vertices, std::vector<Vec3f> offsets,
                   float restWeight = 0) {
    return {std::move(name), restWeight, std::move(vertices), std::move(offsets)};
}

TEST(Morphs, PositionsAreMovedByWhatWeightsDifferFromRest) {
    const std::vector<Vec3f> rest{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    const std::vector<MorphTarget> targets{target("up", {2, 0}, {{0, 2, 0}, {0, 1, 0}}),
                                           target("out", {2}, {{0, 0, 4}}, 0.5f)};
    EXPECT_THAT(morphedPositions(rest, targets, std::vector<float>{0, 0.5f}), IsEmpty());
    EXPECT_THAT(morphedPositions(rest, targets, std::vector<float>{0.5f, 1}),
                ElementsAre(Vec3f(0, 0.5f, 0), Vec3f(1, 0, 0), Vec3f(2, 1, 2)));
    EXPECT_THAT(morphedPositions(rest, targets, std::vector<float>{-1, 0}),
                ElementsAre(Vec3f(0, -1, 0), Vec3f(1, 0, 0), Vec3f(2, -2, -2)));
}

TEST(Morphs, WeightsBlendFromAndToThoseOfRest) {
    const std::vector<MorphTarget> targets{target("a", {0}, {Vec3f::Ones()}),
                                           target("b", {0}, {Vec3f::Ones()}, 0.5f)};
    const std::vector<float> from{1, 1}, to{0, 2};
    EXPECT_THAT(blended(targets, from, to, 0.25f), ElementsAre(0.75f, 1.25f));
    EXPECT_THAT(blended(targets, {}, to, 0.5f), ElementsAre(0, 1.25f));
    EXPECT_THAT(blended(targets, from, {}, 0.5f), ElementsAre(0.5f, 0.75f));
    EXPECT_THAT(blended(targets, {}, {}, 0.5f), IsEmpty());
}

TEST(Morphs, FollowVerticesThatAreRepeatedReorderedAndLeftOut) {
    const std::vector<MorphTarget> targets{target("a", {0, 3}, {{1, 0, 0}, {3, 0, 0}}, 0.25f),
                                           target("b", {1}, {{2, 0, 0}})};
    const auto some = morphsOf(targets, std::vector<std::uint32_t>{3, 2, 0, 3});
    ASSERT_EQ(some.size(), 2u) << "channels go by their numbers";
    EXPECT_EQ(some[0].name, "a");
    EXPECT_EQ(some[0].restWeight, 0.25f);
    EXPECT_THAT(morphedPositions(std::vector<Vec3f>(4, Vec3f::Zero()), some, std::vector<float>{1.25f, 1}),
                ElementsAre(Vec3f(3, 0, 0), Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(3, 0, 0)));
    EXPECT_THAT(some[1].vertices, IsEmpty());
    EXPECT_THAT(morphsOf({}, std::vector<std::uint32_t>{0}), IsEmpty());
}

TEST(Morphs, WhatDoesNotFitIsRefused) {
    const auto problem = [](const MorphTarget& made) {
        const auto status = validate(std::vector<MorphTarget>{made}, 2);
        EXPECT_FALSE(status);
        return status ? std::string() : status.error().message();
    };
    EXPECT_TRUE(validate(std::vector<MorphTarget>{target("a", {1}, {Vec3f::Ones()})}, 2));
    EXPECT_THAT(problem(target("a", {0, 1}, {Vec3f::Ones()})), HasSubstr("'a' has 1 offsets for 2 vertices"));
    EXPECT_THAT(problem(target("a", {2}, {Vec3f::Ones()})), HasSubstr("vertex 2; there are 2"));
    EXPECT_THAT(problem(target("a", {0}, {Vec3f(0, std::nanf(""), 0)})), HasSubstr("not finite"));
    EXPECT_THAT(problem(target("a", {0}, {Vec3f::Ones()}, std::numeric_limits<float>::infinity())),
                HasSubstr("not finite"));
    Clip clip{.name = "talk", .duration = 1};
    clip.morphs = {{1, {{0}, {1}}}};
    EXPECT_TRUE(validate(clip, {}, 2));
    EXPECT_THAT(validate(clip, {}, 1).error().message(), HasSubstr("morph target 1; there are 1"));
    clip.morphs = {{0, {}}};
    EXPECT_THAT(validate(clip, {}, 1).error().message(), HasSubstr("no keys"));
    clip.morphs = {{0, {{0, 0}, {1, 1}}}};
    EXPECT_THAT(validate(clip, {}, 1).error().message(), HasSubstr("ascending"));
    clip.morphs = {{0, {{0}, {std::nanf("")}}}};
    EXPECT_THAT(validate(clip, {}, 1).error().message(), HasSubstr("not finite"));
}

TEST(Morphs, NormalsTurnWithTheFacesAndStayElsewhere) {
    const ScalpMesh ball = meshOf(icosphereSoup(4, 0.1f));
    std::vector<Vec3f> moved(ball.positions().begin(), ball.positions().end());
    // What is above leans, more and more.
    for (Vec3f& p : moved) {
        if (p.y() > 0.05f) p.x() += 5 * (p.y() - 0.05f) * (p.y() - 0.05f);
    }
    const std::vector<Vec3f> normals = morphedNormals(ball, moved);
    const ScalpMesh truth = ball.moved(moved);
    std::size_t turned = 0;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        EXPECT_NEAR(normals[v].norm(), 1, 1e-5f);
        EXPECT_LT((normals[v] - truth.normals()[v]).norm(), 0.02f) << v;
        if (ball.positions()[v].y() < 0.02f) {
            EXPECT_EQ(normals[v], ball.normals()[v]);
        }
        turned += (normals[v] - ball.normals()[v]).norm() > 0.1f;
    }
    EXPECT_GT(turned, 30u);
}

/// A triangle of which the bone moves the last corner, and a clip of bone and target.
class MorphedActor : public testing::Test {
  protected:
    MorphedActor() {
        PolygonSoup soup;
        soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        addFace(soup, {0, 1, 2});
        const auto mesh = std::make_shared<const ScalpMesh>(meshOf(soup));
        Channel turn{.bone = 0, .translation = {}, .rotation = {}, .scale = {}};
        turn.rotation = {{0, 1}, {Quatf::Identity(), Quatf(Eigen::AngleAxisf(kPi / 2, Vec3f::UnitZ()))}};
        Clip both{.name = "both", .duration = 1};
        both.channels = {turn};
        both.morphs = {{0, {{0, 1}, {0, 2}}}};
        Clip bones{.name = "bones", .duration = 1};
        bones.channels = {turn};
        Clip frown{.name = "frown", .duration = 0.5f};
        frown.morphs = {{0, {{0}, {-1}}}};
        SkinWeights skin;
        skin.bones.resize(3);
        skin.weights = {{0, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}};
        auto made = Actor::make(mesh, Skeleton::make({Bone{.name = "jaw"}}).value(), {both, bones, frown},
                                skin, {target("open", {2}, {{0, 0.5f, 0}})});
        EXPECT_TRUE(made);
        actor = std::make_unique<Actor>(std::move(*made));
    }
    std::unique_ptr<Actor> actor;
};

TEST_F(MorphedActor, BonesMoveWhatMorphTargetsHaveMoved) {
    const ActorPose pose = actor->poseAt(0, 0.5f, Wrap::Clamp);
    // Half of the keys: weight 1, 45°.
    EXPECT_EQ(pose.morphed_ss[2], Vec3f(0, 1.5f, 0));
    const float diagonal = 1.5f * std::sqrt(0.5f);
    EXPECT_LT((pose.positions_ws[2] - Vec3f(-diagonal, diagonal, 0)).norm(), 1e-6f);
    EXPECT_EQ(pose.positions_ws[1], Vec3f(1, 0, 0));
}

TEST_F(MorphedActor, ClipsWithoutWeightsPoseAsThoughThereWereNoTargets) {
    EXPECT_THAT(actor->poseAt(1, 0.5f, Wrap::Clamp).morphed_ss, IsEmpty());
    EXPECT_THAT(actor->restPose().morphed_ss, IsEmpty());
    EXPECT_THAT(actor->poseAt(0, 0, Wrap::Clamp).morphed_ss, IsEmpty()) << "weights of rest";
}

TEST_F(MorphedActor, ClipsBlendBonesAndWeights) {
    const ActorPose pose = actor->poseBetween({0, 1, Wrap::Clamp}, {2, 0, Wrap::Clamp}, 0.5f);
    // Between 2 and −1, and between 90° and 0.
    EXPECT_LT((pose.morphed_ss[2] - Vec3f(0, 1.25f, 0)).norm(), 1e-6f);
    const float diagonal = 1.25f * std::sqrt(0.5f);
    EXPECT_LT((pose.positions_ws[2] - Vec3f(-diagonal, diagonal, 0)).norm(), 1e-6f);
}

TEST_F(MorphedActor, TargetsOfOtherMeshesAreRefused) {
    const auto mesh = std::make_shared<const ScalpMesh>(actor->mesh());
    EXPECT_FALSE(Actor::make(mesh, {}, {}, {}, {target("a", {3}, {Vec3f::Ones()})}));
    Clip clip{.name = "talk", .duration = 1};
    clip.morphs = {{0, {{0}, {1}}}};
    EXPECT_FALSE(Actor::make(mesh, {}, {clip}, {}, {}));
}

}  // namespace
}  // namespace hairloom::test
