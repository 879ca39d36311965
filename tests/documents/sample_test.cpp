// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/documents/motions.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "core/live/groom_scene.h"
#include "core/operations/skin.h"
#include "core/stability/certificate.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

const std::filesystem::path kSamples = sourceDir() / "samples";

TEST(SampleTest, TheFolderIsFoundFromBelowAndNotElsewhere) {
    EXPECT_EQ(findSamples(kSamples.parent_path() / "no/such/folder/bin"), kSamples);
    EXPECT_EQ(findSamples("/"), std::filesystem::path());
}

TEST(SampleTest, SamplesAreCompleteAndDeterministic) {
    EXPECT_THAT(sampleNames(kSamples),
                testing::ElementsAre("afro", "bob", "braid", "long", "short", "shoulder"));
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

TEST(SampleTest, TheSkinProtectsWhatPeopleOpen) {
    const auto made = makeSample(kSamples, "bob", SampleColliders::skin);
    ASSERT_TRUE(made) << made.error().message();
    ASSERT_TRUE(made->body);
    EXPECT_THAT(made->body->bones, testing::Contains("head"));
    Groom bare = *made;
    bare.body.reset();
    EXPECT_EQ(contentHash(bare), contentHash(*makeSample(kSamples, "bob")));
}

/// Of every seventh strand.
std::size_t pointsInsideTheHead(const Groom& groom) {
    const Skin skin(groom.scalp);
    std::size_t inside = 0;
    for (std::size_t s = 0; s < groom.strandCount(); s += 7) {
        for (const Vec3f& point : groom.strand(s).subspan(1)) inside += skin.at(point).distance < 0 ? 1 : 0;
    }
    return inside;
}

TEST(SampleTest, GroomedSamplesKeepTheirStackMasksAndGradedHairline) {
    for (const std::string& name : sampleNames(kSamples)) {
        const auto made = makeSample(kSamples, name);
        ASSERT_TRUE(made) << name << ": " << made.error().message();
        EXPECT_FALSE(hasErrors(validate(*made))) << name;
        EXPECT_GE(made->operators.size(), 7u) << name;
        EXPECT_EQ(std::ranges::count(made->operators, "flyaways", &Operator::op), 1) << name;
        EXPECT_TRUE(made->strandAttributes.has("mask.1")) << name << ": its operators have painted masks";
        EXPECT_FALSE(made->scalpDensity.empty()) << name << ": sparse at the hairline";
        EXPECT_EQ(pointsInsideTheHead(*made), 0u) << name;
        const auto again = makeSample(kSamples, name);
        ASSERT_TRUE(again);
        EXPECT_EQ(contentHash(*again), contentHash(*made)) << name;
    }
}

TEST(SampleTest, TheFringeEndsAboveTheEyesAndTheBobAtTheChin) {
    const auto made = makeSample(kSamples, "bob");
    ASSERT_TRUE(made) << made.error().message();
    const auto fringe = made->strandAttributes.view<float>("mask.1");
    float lowest = 2, lowestOfFringe = 2;
    std::size_t ofFringe = 0, ofRest = 0;
    for (std::size_t s = 0; s < made->strandCount(); ++s) {
        for (const Vec3f& point : made->strand(s)) {
            lowest = std::min(lowest, point.y());
            if (fringe[s] == 1) lowestOfFringe = std::min(lowestOfFringe, point.y());
        }
        ++(fringe[s] == 1 ? ofFringe : ofRest);
    }
    EXPECT_GT(ofFringe, 150u);
    EXPECT_GT(ofRest, 2000u);
    EXPECT_GT(lowestOfFringe, 1.67f) << "eyes are at 1.66 m";
    EXPECT_GT(lowest, 1.55f);
    EXPECT_LT(lowest, 1.6f);
}

TEST(SampleTest, LongHairComesToRestAmongItsSpheresAfterStorms) {
    const auto groom = makeSample(kSamples, "long");
    ASSERT_TRUE(groom) << groom.error().message();
    CertificateOptions options;
    options.storms = 60;
    const auto certificate = certify(*groom, options);
    ASSERT_TRUE(certificate) << certificate.error().message();
    EXPECT_TRUE(certificate->failed.empty()) << inWords(*certificate);
    EXPECT_GE(certificate->calm, 58u) << "nearly all end with every point of eight strands below 5 mm/s";
    // In storm 28 a strand trembles on the edge of an ear, and sleeps there.
    EXPECT_EQ(certificate->calmLate, 60u);
}

TEST(GroomSceneTest, PosingMovesHeadAndHairAndBackAgain) {
    auto groom = makeSample(kSamples, "short");
    ASSERT_TRUE(groom);
    groom->interpolation.followPerGuide = 2;
    auto scene = GroomScene::make(*groom, {}, {});
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
    scene->pose(moved, {}, pose);
    const std::vector<Vec3f> posed = points();
    for (std::size_t p = 0; p < rest.size(); p += 97) {
        EXPECT_LT((posed[p] - rest[p] - Vec3f(0, 0, 1)).norm(), 1e-4f) << p;
    }
    EXPECT_LT((scene->scene().meshes.front().positions_ws[0] - groom->scalp->positions()[0] - Vec3f(0, 0, 1))
                  .norm(),
              1e-5f);
    scene->pose(groom->positions(), {}, {});
    EXPECT_EQ(points(), rest);
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
