// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of a groom: made, kept with their strands, weighed, saved, compared, keyed.
#include "core/groom/poses.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>
#include <memory>

#include "core/groom/file/poses_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_diff.h"
#include "core/groom/groom_hash.h"
#include "core/groom/strand_subset.h"
#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

Groom hair() {
    return straightHair(sphereScalp(), 40, 9, 0.1f);
}

/// Each strand turned about its root.
std::vector<Vec3f> turned(const Groom& groom, float angle = 0.7f) {
    std::vector<Vec3f> shape(groom.positions().begin(), groom.positions().end());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const Vec3f root = groom.strand(s)[0];
        for (std::uint32_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p)
            shape[p] = root + Eigen::AngleAxisf(angle, Vec3f::UnitX()) * (shape[p] - root);
    }
    return shape;
}

Groom posedHair(float amount = 0.5f) {
    Groom groom = hair();
    EXPECT_TRUE(putPose(groom, "Windswept", turned(groom)));
    groom.poses[0].amount = amount;
    return groom;
}

TEST(Poses, AreSavedAndCompared) {
    const TemporaryFolder folder;
    Groom groom = posedHair();
    groom.poses[0].mask = 2;
    groom.poses[0].ramp = runtime::Ramp::straight(0, 1);
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    const auto loaded = readProjectFile(folder / "a.hairloom");
    ASSERT_TRUE(loaded) << loaded.error().message();
    EXPECT_TRUE(sameContent(*loaded, groom));
    EXPECT_EQ(loaded->poses, groom.poses);
    EXPECT_THAT(validate(*loaded), testing::IsEmpty());

    Groom other = groom;
    other.poses[0].amount = 0.75f;
    EXPECT_NE(contentHash(other), contentHash(groom));
    const auto amount = compare({groom, {}}, {other, {}}).differences;
    ASSERT_EQ(amount.size(), 1u);
    EXPECT_EQ(amount[0].where, "poses[Windswept].amount");
    other = groom;
    ASSERT_TRUE(putPose(other, "Windswept", turned(groom, 0.2f)));
    const auto shape = compare({groom, {}}, {other, {}}).differences;
    ASSERT_EQ(shape.size(), 1u);
    EXPECT_EQ(shape[0].where, "points.pose.Windswept");
}

TEST(Poses, GoWithTheirStrands) {
    const Groom groom = posedHair();
    const std::vector<std::uint32_t> strands{3, 17, 29};
    const Groom some = strandsOf(groom, strands);
    EXPECT_EQ(some.poses, groom.poses);
    EXPECT_THAT(validate(some), testing::IsEmpty());
    const auto all = groom.pointAttributes.view<Vec3f>(poseAttribute("Windswept"));
    const auto kept = some.pointAttributes.view<Vec3f>(poseAttribute("Windswept"));
    for (std::size_t s = 0; s < strands.size(); ++s) EXPECT_EQ(kept[9 * s + 8], all[9 * strands[s] + 8]);
}

/// Another groom's strands stand in another order: ids say which is which.
TEST(Poses, OfAnotherGroomFindTheirStrands) {
    Groom groom = hair();
    Groom other = groom;
    other.pointAttributes.set(attribute::kPosition, turned(groom));
    std::vector<std::uint32_t> backwards(groom.strandCount());
    for (std::uint32_t s = 0; s < backwards.size(); ++s)
        backwards[s] = static_cast<std::uint32_t>(backwards.size()) - 1 - s;
    ASSERT_TRUE(groom.strandAttributes.has(attribute::kStrandId));
    const auto put = putPoseOf(groom, "Other", strandsOf(other, backwards));
    ASSERT_TRUE(put) << put.error().message();
    const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute("Other"));
    const std::vector<Vec3f> expected = turned(groom);
    for (std::size_t p = 0; p < expected.size(); ++p) EXPECT_EQ(shape[p], expected[p]);
}

TEST(Poses, OfOtherStrandsAreRefusedInWords) {
    Groom groom = hair();
    const Groom before = groom;
    const auto why = [&](const Groom& other) {
        const auto put = putPoseOf(groom, "Other", other);
        return put ? std::string("it was taken") : put.error().message();
    };
    EXPECT_THAT(why(strandsOf(groom, std::vector<std::uint32_t>{1, 2})),
                HasSubstr("38 of 40 are not there, and 0 are new"));
    Groom other = straightHair(sphereScalp(), 40, 12, 0.1f);
    EXPECT_THAT(why(other), HasSubstr("strand 0 of the pose has 12 points; expected 9, as it has here"));
    other = hair();
    other.pointAttributes.edit<Vec3f>(attribute::kPosition)[5].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(why(other), HasSubstr("is not finite"));
    EXPECT_TRUE(sameContent(groom, before));
    EXPECT_FALSE(putPose(groom, "", groom.positions()));
    EXPECT_FALSE(putPose(groom, "a/b", groom.positions()));
    EXPECT_FALSE(putPose(groom, std::string(65, 'a'), groom.positions()));
    const auto none = removePose(groom, "Wet");
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), HasSubstr("no pose is called 'Wet'"));
    const std::vector<Vec3f> shape = turned(groom);
    for (std::size_t k = 0; k < kMaxGroomPoses; ++k) ASSERT_TRUE(putPose(groom, freshPoseName(groom), shape));
    EXPECT_FALSE(putPose(groom, "One more", shape));
    EXPECT_TRUE(putPose(groom, "Pose 3", shape)) << "it is there";
}

TEST(Poses, WeightsAreMaskTimesRamp) {
    Groom groom = posedHair();
    GroomPose pose = groom.poses[0];
    for (const float weight : poseWeights(groom, pose)) EXPECT_EQ(weight, 1);
    pose.ramp = runtime::Ramp::straight(0, 1);
    std::vector<float> painted(groom.strandCount(), 0.0f);
    painted[7] = 0.5f;
    groom.strandAttributes.set(maskAttribute(3), painted);
    pose.mask = 3;
    std::vector<float> weights = poseWeights(groom, pose);
    EXPECT_EQ(weights[9 * 6 + 8], 0);
    EXPECT_EQ(weights[9 * 7], 0);
    EXPECT_NEAR(weights[9 * 7 + 4], 0.25f, 1e-4f);
    EXPECT_NEAR(weights[9 * 7 + 8], 0.5f, 1e-4f);
    pose.invert = true;
    weights = poseWeights(groom, pose);
    EXPECT_NEAR(weights[9 * 6 + 8], 1, 1e-4f);
    EXPECT_NEAR(weights[9 * 7 + 8], 0.5f, 1e-4f);
    // Strands that came after the pose do not fly to where it has nothing of them.
    auto& shape = groom.pointAttributes.edit<Vec3f>(poseAttribute("Windswept"));
    std::fill_n(shape.begin() + 9 * 2, 9, Vec3f::Zero());
    weights = poseWeights(groom, groom.poses[0]);
    EXPECT_EQ(weights[9 * 2 + 8], 0);
    EXPECT_EQ(weights[9 * 3 + 8], 1);
}

TEST(Poses, AreKeyed) {
    const Groom groom = posedHair(0.25f);
    EXPECT_THAT(keyableNames(groom), testing::Contains("pose.Windswept"));
    EXPECT_NE(findKeyable("pose.Windswept"), nullptr);
    EXPECT_EQ(findKeyable("pose."), nullptr);
    EXPECT_EQ(authoredValue(groom, "pose.Windswept")[0], 0.25);
    TimeLine line;
    line.settings = {{"pose.Windswept", {{0, Vec3d(0, 0, 0)}, {2, Vec3d(1, 0, 0)}}}};
    EXPECT_THAT(problemsOf(line), testing::IsEmpty());
    EXPECT_FALSE(keysSimulation(line));
    Groom keyed = posedHair(0);
    EXPECT_FALSE(followsPoses(keyed));
    keyed.timeLine = std::make_shared<const TimeLine>(line);
    EXPECT_TRUE(followsPoses(keyed));
    EXPECT_FLOAT_EQ(poseAmountsAt(line, 0.5f, groom.poses)[0], 0.25f);
    EXPECT_FLOAT_EQ(poseAmountsAt(line, 1.5f, groom.poses)[0], 0.75f);
    EXPECT_FLOAT_EQ(poseAmountsAt(TimeLine(), 1.5f, groom.poses)[0], 0.25f) << "what is not keyed stays";
    line.settings[0].keys[1].value[0] = 1.5;
    EXPECT_THAT(problemsOf(line), testing::Not(testing::IsEmpty()));
}

TEST(Poses, ValidationNamesWhatIsWrong) {
    const auto found = [](const Groom& groom) {
        std::string all;
        for (const Finding& finding : validate(groom))
            all += fmt::format("{} {} ({}); ", severityName(finding.severity), finding.what, finding.where);
        return all;
    };
    Groom groom = posedHair();
    groom.pointAttributes.erase(poseAttribute("Windswept"));
    EXPECT_THAT(found(groom), HasSubstr("warning has no shape, so nothing follows it (pose 'Windswept')"));
    groom = posedHair();
    groom.pointAttributes.edit<Vec3f>(poseAttribute("Windswept"))[3].x() =
        std::numeric_limits<float>::infinity();
    EXPECT_THAT(found(groom), HasSubstr("error point 3 of the pose is not finite (pose 'Windswept')"));
    groom = posedHair();
    groom.poses[0].amount = 2;
    EXPECT_THAT(found(groom), HasSubstr("pose 'Windswept'"));
    groom = posedHair();
    groom.poses.push_back(groom.poses[0]);
    EXPECT_THAT(found(groom), HasSubstr("two poses have one name"));
}

}  // namespace
}  // namespace hairloom
