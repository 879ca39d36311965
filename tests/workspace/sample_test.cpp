// SPDX-License-Identifier: GPL-3.0-or-later
#include "workspace/sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "workspace/groom_scene.h"
#include "workspace/motions.h"

namespace hairloom {
namespace {

const std::filesystem::path kSamples = std::filesystem::path(HAIRLOOM_SOURCE_DIR) / "samples";

TEST(SampleTest, TheFolderIsFoundFromBelowAndNotElsewhere) {
    EXPECT_EQ(findSamples(kSamples.parent_path() / "no/such/folder/bin"), kSamples);
    EXPECT_EQ(findSamples("/"), std::filesystem::path());
}

TEST(SampleTest, ASampleIsWholeAndTheSameEachTime) {
    EXPECT_THAT(sampleNames(kSamples), testing::ElementsAre("long", "short", "shoulder"));
    const auto made = makeSample(kSamples, "short");
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_EQ(made->strandCount(), 4000u);
    EXPECT_EQ(made->pointCount(), 4000u * 24);
    EXPECT_FALSE(made->spheres.empty());
    EXPECT_FALSE(hasErrors(validate(*made)));
    const auto again = makeSample(kSamples, "short");
    ASSERT_TRUE(again);
    EXPECT_EQ(contentHash(*again), contentHash(*made));
    EXPECT_FALSE(makeSample(kSamples, "no such style"));
}

TEST(GroomSceneTest, PosingMovesHeadAndHairAndBackAgain) {
    auto groom = makeSample(kSamples, "short");
    ASSERT_TRUE(groom);
    groom->interpolation.followPerGuide = 2;
    auto scene = GroomScene::make(*groom, nullptr, nullptr, {}, {});
    ASSERT_TRUE(scene) << scene.error().message();
    const auto points = [&] {
        const auto view = scene->scene().strands.front().positions_ws;
        return std::vector<Vec3f>(view.begin(), view.end());
    };
    const std::vector<Vec3f> rest = points();
    EXPECT_EQ(rest.size(), groom->pointCount() * groom->interpolation.followPerGuide);
    HeadPose pose;
    pose.head_ws = Eigen::Translation3f(0, 0, 1) * Eigen::Isometry3f::Identity();
    std::vector<Vec3f> moved(groom->positions().begin(), groom->positions().end());
    for (Vec3f& point : moved) point = pose.head_ws * point;
    ASSERT_TRUE(scene->pose(moved, pose));
    const std::vector<Vec3f> posed = points();
    for (std::size_t p = 0; p < rest.size(); p += 97) {
        EXPECT_LT((posed[p] - rest[p] - Vec3f(0, 0, 1)).norm(), 1e-4f) << p;
    }
    EXPECT_LT((scene->scene().meshes.front().positions_ws[0] - groom->scalp->positions()[0] - Vec3f(0, 0, 1))
                  .norm(),
              1e-5f);
    ASSERT_TRUE(scene->pose(groom->positions(), {}));
    EXPECT_EQ(points(), rest);
}

TEST(FibreMaterialTest, WhatAnArtistTurnsOfALobeChangesThatLobeAlone) {
    FibreView view;
    view.model = render::ShadingModel::sadeghi;
    const HairMaterial plain;
    const auto before = fibreMaterial(plain, view).sadeghi;
    HairMaterial turned = plain;
    turned.ttIntensity = 2;
    turned.trtWidth = 0.5f;
    turned.rShift = 3;
    turned.ttTint = Vec3f(0.5f, 1, 1);
    turned.ttSpread = 2;
    turned.glintWidth = 3;
    turned.glintNearDegrees = 50;
    turned.glintFarDegrees = 20;
    const auto after = fibreMaterial(turned, view).sadeghi;
    EXPECT_DOUBLE_EQ(after.tt.intensity, 2 * before.tt.intensity);
    EXPECT_DOUBLE_EQ(after.tt.colour.x(), 0.5 * before.tt.colour.x());
    EXPECT_DOUBLE_EQ(after.tt.colour.y(), before.tt.colour.y());
    EXPECT_DOUBLE_EQ(after.tt.width, before.tt.width);
    EXPECT_DOUBLE_EQ(after.trt.width, 0.5 * before.trt.width);
    EXPECT_DOUBLE_EQ(after.trt.shift, before.trt.shift);
    EXPECT_NEAR(after.r.shift, before.r.shift + 3 * shading::kDegree, 1e-12);
    EXPECT_DOUBLE_EQ(after.r.intensity, before.r.intensity);
    EXPECT_DOUBLE_EQ(after.ttAzimuthalWidth, 2 * before.ttAzimuthalWidth);
    EXPECT_DOUBLE_EQ(after.glintWidth, 3 * before.glintWidth);
    EXPECT_NEAR(after.glintNear, 20 * shading::kDegree, 1e-12) << "the nearer of the two, whichever is which";
    EXPECT_NEAR(after.glintFar, 50 * shading::kDegree, 1e-12);
}

TEST(FibreMaterialTest, MarschnersControlsReachItsParameters) {
    FibreView view;
    view.model = render::ShadingModel::marschner;
    HairMaterial turned;
    turned.trtIntensity = 0;
    turned.eccentricity = 0.8f;
    turned.causticFade = 0.7f;
    const auto m = fibreMaterial(turned, view).marschner;
    EXPECT_EQ(m.intensity[2], 0);
    EXPECT_EQ(m.intensity[0], 1);
    EXPECT_NEAR(m.azimuthal.axisRatio, 1 / 0.6, 1e-6);
    EXPECT_FLOAT_EQ(static_cast<float>(m.azimuthal.causticFade), 0.7f);
}

TEST(MotionsTest, ClipsComeFromTheGroomsOwnFile) {
    const auto groom = makeSample(kSamples, "short");
    ASSERT_TRUE(groom);
    const auto actor = loadActor({}, *groom);
    ASSERT_TRUE(actor) << actor.error().message();
    EXPECT_FALSE((*actor)->clips().empty());
    EXPECT_TRUE(makeMotion("nod", {}, *groom));
    EXPECT_TRUE(makeMotion("clip:nod_and_turn", {}, *groom));
    EXPECT_FALSE(makeMotion("clip:no_such", {}, *groom));
    EXPECT_FALSE(makeMotion("clip:nod_and_turn", {}, Groom()));
}

}  // namespace
}  // namespace hairloom
