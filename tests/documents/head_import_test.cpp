// SPDX-License-Identifier: GPL-3.0-or-later
// Heads taken out of files with more than a head: groups that are left out, and those that hair collides
// with.
#include "core/documents/head_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/animation/actor.h"
#include "core/documents/motions.h"
#include "core/editing/sphere_parts.h"
#include "tests/geometry/test_meshes.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kBust = (sourceDir() / "samples/bust/bust.glb").string();

struct Ball {
    std::string group;
    float radius;
    Vec3f at;
};

PolygonSoup soupOf(const std::vector<Ball>& balls) {
    PolygonSoup soup;
    for (const Ball& ball : balls) {
        test::append(soup, test::icosphereSoup(4, ball.radius), ball.at);
        soup.faceGroups.resize(soup.offsets.size() - 1, static_cast<std::uint32_t>(soup.groupNames.size()));
        soup.groupNames.push_back(ball.group);
    }
    return soup;
}
void addTriangle(PolygonSoup& soup, const std::string& group, const Vec3f& at, float size) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const Vec3f& corner : {Vec3f(0, 0, 0), Vec3f(size, 0, 0), Vec3f(0, 0, size)})
        soup.positions.push_back(at + corner);
    test::addFace(soup, {first, first + 1, first + 2});
    soup.faceGroups.push_back(static_cast<std::uint32_t>(soup.groupNames.size()));
    soup.groupNames.push_back(group);
}

const std::vector<Ball> kHeadAndClothes{
    {"head", 0.1f, {0, 1.6f, 0}}, {"collar", 0.06f, {0, 1.4f, 0.02f}}, {"hat", 0.05f, {0, 1.8f, 0}}};

HeadImportOptions collidingWith(std::vector<std::string> groups, std::uint32_t spheres) {
    HeadImportOptions options;
    options.collideWith = std::move(groups);
    options.colliderSpheres = spheres;
    return options;
}
std::string refusal(const ScalpMesh& mesh, const HeadImportOptions& options) {
    const auto part = partOfHead(mesh, options);
    const auto fit = fitColliders(mesh, {}, options);
    return !part ? part.error().message() : !fit ? fit.error().message() : std::string();
}

TEST(HeadImport, ACollarIsNoPartOfTheHeadAndHasItsSphere) {
    const ScalpMesh mesh = test::meshOf(soupOf(kHeadAndClothes));
    const auto options = collidingWith({"collar"}, 1);
    const auto head = partOfHead(mesh, options);
    ASSERT_TRUE(head);
    EXPECT_THAT(head->groupNames(), ElementsAre("head", "hat"));
    const auto fit = fitColliders(mesh, {}, options);
    ASSERT_TRUE(fit) << fit.error().message();
    ASSERT_EQ(fit->spheres.size(), 1u);
    EXPECT_EQ(fit->spheres[0].name, "group:collar 1");
    EXPECT_EQ(fit->spheres[0].bone, "");
    EXPECT_LT((fit->spheres[0].centre - kHeadAndClothes[1].at).norm(), 2e-4f);
    EXPECT_NEAR(fit->spheres[0].radius, 0.06f, 2e-4f);
    EXPECT_LT(fit->worstGap, 3e-4f);
}

TEST(HeadImport, SpheresTurnWithTheHead) {
    const ScalpMesh mesh = test::meshOf(soupOf(kHeadAndClothes));
    auto options = collidingWith({"collar"}, 1);
    options.zUp = true;
    const auto fit = fitColliders(mesh, {}, options);
    ASSERT_TRUE(fit);
    EXPECT_LT((fit->spheres[0].centre - Vec3f(0, 0.02f, -1.4f)).norm(), 2e-4f);
}

TEST(HeadImport, SpheresAreSharedByAreaAndEachGroupHasOne) {
    // 4 : 1 by area.
    const ScalpMesh mesh = test::meshOf(
        soupOf({{"head", 0.1f, {0, 0, 0}}, {"coat", 0.1f, {1, 0, 0}}, {"scarf", 0.05f, {2, 0, 0}}}));
    for (const auto& [count, coat, scarf] :
         std::vector<std::array<std::uint32_t, 3>>{{1, 1, 1}, {2, 1, 1}, {5, 4, 1}, {10, 8, 2}}) {
        const auto fit = fitColliders(mesh, {}, collidingWith({"coat", "scarf"}, count));
        ASSERT_TRUE(fit);
        const auto of = [&](const char* group) {
            return std::ranges::count_if(fit->spheres, [&](const CollisionSphere& sphere) {
                return sphere.name.starts_with("group:" + std::string(group));
            });
        };
        EXPECT_EQ(of("coat"), coat) << count;
        EXPECT_EQ(of("scarf"), scarf) << count;
    }
}

TEST(HeadImport, AGroupInAnotherIsFittedAsIfItWereAlone) {
    const ScalpMesh mesh = test::meshOf(
        soupOf({{"head", 0.1f, {0, 1, 0}}, {"body", 0.08f, {0, 0, 0}}, {"shirt", 0.09f, {0, 0, 0}}}));
    const auto fit = fitColliders(mesh, {}, collidingWith({"body", "shirt"}, 2));
    ASSERT_TRUE(fit);
    ASSERT_EQ(fit->spheres.size(), 2u);
    EXPECT_NEAR(fit->spheres[0].radius, 0.08f, 3e-4f);
    EXPECT_NEAR(fit->spheres[1].radius, 0.09f, 3e-4f);
}

TEST(HeadImport, WhatIsLeftOutMayCollideAllTheSame) {
    const ScalpMesh mesh = test::meshOf(soupOf(kHeadAndClothes));
    auto options = collidingWith({"c*"}, 1);
    options.leaveOut = {"collar", "hat"};
    const auto head = partOfHead(mesh, options);
    ASSERT_TRUE(head);
    EXPECT_THAT(head->groupNames(), ElementsAre("head"));
    const auto fit = fitColliders(mesh, {}, options);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->spheres.size(), 1u);
}

TEST(HeadImport, SmallGroupsHaveSpheresOfTheirSize) {
    PolygonSoup soup = soupOf({{"head", 0.1f, {0, 1, 0}}});
    const std::vector<float> sizes{0.02f, 0.004f, 1e-3f, 1e-5f};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        addTriangle(soup, "button" + std::to_string(i), {0, 0.1f * static_cast<float>(i), 0}, sizes[i]);
    }
    const ScalpMesh mesh = test::meshOf(soup);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto fit = fitColliders(mesh, {}, collidingWith({"button" + std::to_string(i)}, 4));
        ASSERT_TRUE(fit) << sizes[i] << ": " << fit.error().message();
        for (const CollisionSphere& sphere : fit->spheres) {
            EXPECT_GE(sphere.radius, 0.00099f);
            EXPECT_LE(sphere.radius, std::max(0.001f, 0.7072f * sizes[i]));
            EXPECT_LT((sphere.centre - Vec3f(0, 0.1f * static_cast<float>(i), 0)).norm(),
                      std::max(0.002f, 2 * sizes[i]));
        }
        EXPECT_LE(fit->worstBulge, std::max(0.001f, 0.1f * sizes[i])) << sizes[i];
    }
    const auto all = fitColliders(mesh, {}, collidingWith({"button*"}, 1));
    ASSERT_TRUE(all) << all.error().message();
    EXPECT_EQ(all->spheres.size(), sizes.size());
}

TEST(HeadImport, GroupsOfOneNameAreOne) {
    const ScalpMesh mesh = test::meshOf(
        soupOf({{"head", 0.1f, {0, 0, 0}}, {"glove", 0.1f, {1, 0, 0}}, {"glove", 0.1f, {2, 0, 0}}}));
    const auto fit = fitColliders(mesh, {}, collidingWith({"glove"}, 2));
    ASSERT_TRUE(fit);
    ASSERT_EQ(fit->spheres.size(), 2u);
    EXPECT_NE(fit->spheres[0].name, fit->spheres[1].name);
    EXPECT_NEAR(std::abs(fit->spheres[0].centre.x() - fit->spheres[1].centre.x()), 1, 1e-3f);
}

TEST(HeadImport, RefusesWhatCannotBe) {
    PolygonSoup soup = soupOf(kHeadAndClothes);
    addTriangle(soup, "flat", {0, 0, 0}, 0);
    const ScalpMesh mesh = test::meshOf(soup);
    EXPECT_THAT(refusal(mesh, collidingWith({"coller"}, 4)),
                HasSubstr("no group 'coller'; expected one of: "));
    EXPECT_THAT(refusal(mesh, collidingWith({"flat"}, 4)), HasSubstr("'flat' has no faces to collide with"));
    EXPECT_THAT(refusal(mesh, collidingWith({"*"}, 4)), HasSubstr("no head is left"));
    EXPECT_THAT(refusal(mesh, collidingWith({"hat"}, 0)), HasSubstr("0 spheres"));
    EXPECT_THAT(refusal(mesh, collidingWith({"hat"}, 257)), HasSubstr("1 to 256"));
    auto apart = collidingWith({"hat", "collar"}, 4);
    apart.leaveOut = {"head"};
    EXPECT_THAT(refusal(mesh, apart), HasSubstr("no head is left"));
    EXPECT_EQ(refusal(mesh, collidingWith({"f*", "hat"}, 4)).empty(), false) << "f* has no faces";
    EXPECT_EQ(refusal(mesh, collidingWith({"h*t"}, 4)).empty(), false);
    EXPECT_EQ(refusal(mesh, collidingWith({"hat"}, 4)), "");
}

TEST(HeadImport, FittingStopsWhenItIsCancelled) {
    const ScalpMesh mesh = test::meshOf(soupOf(kHeadAndClothes));
    const std::atomic<bool> cancelled = true;
    EXPECT_FALSE(fitColliders(mesh, {}, collidingWith({"hat"}, 4), &cancelled));
}

/// Where each point of the rest pose is at a time of the first clip.
auto posed(const Actor& actor, float time) {
    const ActorPose pose = actor.poseAt(0, time, Wrap::Loop);
    std::map<std::array<float, 3>, Vec3f> places;
    for (std::size_t v = 0; v < pose.positions_ws.size(); ++v) {
        const Vec3f& rest = actor.mesh().positions()[v];
        places[{rest.x(), rest.y(), rest.z()}] = pose.positions_ws[v];
    }
    return places;
}

TEST(HeadImport, APartOfACharacterMovesAsTheWholeDoesAndItsSpheresToo) {
    const auto options = collidingWith({"bust_shoulders"}, 5);
    auto head = importHead(kBust, options);
    ASSERT_TRUE(head) << head.error().message();
    auto whole = importScene(kBust);
    ASSERT_TRUE(whole);
    std::set<std::string> bones;
    for (const Bone& bone : whole->skeleton.bones()) bones.insert(bone.name);
    ASSERT_EQ(head->colliders.spheres.size(), 5u);
    for (const CollisionSphere& sphere : head->colliders.spheres) {
        EXPECT_TRUE(bones.contains(sphere.bone)) << sphere.bone;
        EXPECT_LT(sphere.centre.y(), 1.6f) << "beside the head";
    }

    Groom groom;
    groom.scalp = std::make_shared<const ScalpMesh>(std::move(head->scene.mesh));
    groom.characterFile = kBust;
    ASSERT_LT(groom.scalp->triangleCount(), whole->mesh.triangleCount());
    const auto all = Actor::make(std::make_shared<const ScalpMesh>(whole->mesh), whole->skeleton,
                                 whole->clips, whole->skin);
    const auto imported = Actor::make(groom.scalp, head->scene.skeleton, head->scene.clips, head->scene.skin);
    const auto loaded = loadActor({}, groom);
    ASSERT_TRUE(all && imported && loaded);
    EXPECT_EQ(&(*loaded)->mesh(), groom.scalp.get());
    float farthest = 0;
    for (const float time : {0.2f, 0.7f, 1.1f}) {
        const auto expected = posed(*all, time);
        const auto here = posed(*imported, time), again = posed(**loaded, time);
        ASSERT_EQ(here.size(), again.size());
        for (const auto& [rest, place] : here) {
            EXPECT_EQ(place, expected.at(rest));
            EXPECT_EQ(place, again.at(rest));
            farthest = std::max(farthest, (place - Vec3f(rest[0], rest[1], rest[2])).norm());
        }
    }
    EXPECT_GT(farthest, 0.005f) << "the clip moves it";
    EXPECT_TRUE(makeMotion("clip:nod_and_turn", {}, groom));
}

TEST(HeadImport, AHeadThatIsTurnedHasNoSkeleton) {
    auto options = collidingWith({"bust_shoulders"}, 2);
    options.zUp = true;
    const auto head = importHead(kBust, options);
    ASSERT_TRUE(head);
    EXPECT_TRUE(head->scene.skeleton.empty());
    EXPECT_EQ(head->colliders.spheres[0].bone, "");
}

TEST(HeadImport, TheSameSpheresEachTime) {
    const auto options = collidingWith({"bust_shoulders", "bust_neck"}, 9);
    const auto once = importHead(kBust, options), twice = importHead(kBust, options);
    ASSERT_TRUE(once && twice);
    for (std::size_t s = 0; s < 9; ++s) {
        EXPECT_EQ(once->colliders.spheres[s].centre, twice->colliders.spheres[s].centre);
        EXPECT_EQ(once->colliders.spheres[s].radius, twice->colliders.spheres[s].radius);
    }
}

}  // namespace
}  // namespace hairloom
