// SPDX-License-Identifier: GPL-3.0-or-later
// Poses are made, changed, renamed and removed in steps that are undone and replayed.
#include <gmock/gmock.h>

#include "core/editing/pose_commands.h"
#include "core/editing/settings_commands.h"
#include "core/groom/poses.h"
#include "core/operations/script.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

void perform(Document& document, Result<std::unique_ptr<Command>> command) {
    ASSERT_TRUE(command) << command.error().message();
    ASSERT_NE(*command, nullptr);
    document.perform(std::move(*command));
}

TEST(PoseCommands, AreUndoneStepByStepAndReplayed) {
    Document document(hairOnHead(60, 8));
    std::vector<std::uint64_t> hashes{contentHash(document.groom())};
    const auto step = [&](Result<std::unique_ptr<Command>> command) {
        perform(document, std::move(command));
        hashes.push_back(contentHash(document.groom()));
    };
    std::vector<Vec3f> other(document.groom().positions().begin(), document.groom().positions().end());
    for (Vec3f& point : other) point.x() += 0.3f * (point.y() - 1.6f);
    step(poseOfShape(document.model(), "Rest"));
    step(putPose(document.model(), "Swept", other));
    std::vector<GroomPose> poses = document.groom().poses;
    poses[1].amount = 0.5f;
    poses[1].ramp = runtime::Ramp::straight(0.25f, 1);
    step(setPoses(document.model(), poses));
    TimeLine line;
    line.settings = {{"pose.Swept", {{0, Vec3d(0, 0, 0)}, {1, Vec3d(1, 0, 0)}}}};
    step(setTimeLine(document.model(), line, "Key"));
    step(swapPose(document.model(), "Swept"));
    EXPECT_NE(document.groom().strand(3)[7], hairOnHead(60, 8).strand(3)[7]);
    step(swapPose(document.model(), "Swept"));
    EXPECT_EQ(document.groom().strand(3)[7], hairOnHead(60, 8).strand(3)[7]) << "there and back";
    step(renamePose(document.model(), "Swept", "Blown"));
    EXPECT_EQ(document.groom().timeLine->settings[0].name, "pose.Blown");
    EXPECT_TRUE(document.groom().pointAttributes.has(poseAttribute("Blown")));
    EXPECT_FALSE(document.groom().pointAttributes.has(poseAttribute("Swept")));
    step(removePose(document.model(), "Rest"));
    ASSERT_EQ(document.groom().poses.size(), 1u);
    EXPECT_EQ(document.groom().poses[0].amount, 0.5f);

    const auto text = document.script();
    ASSERT_TRUE(text) << text.error().message();
    const auto script = parseScript("s.json", *text, scriptExtensions());
    ASSERT_TRUE(script) << script.error().message();
    Groom scripted = hairOnHead(60, 8);
    const auto run = runScript(*script, scripted);
    ASSERT_TRUE(run) << run.error().message();
    EXPECT_EQ(contentHash(scripted), hashes.back());

    for (std::size_t i = hashes.size() - 1; i-- > 0;) {
        document.undo();
        EXPECT_EQ(contentHash(document.groom()), hashes[i]) << i;
    }
    for (std::size_t i = 1; i < hashes.size(); ++i) document.redo();
    EXPECT_EQ(contentHash(document.groom()), hashes.back());
}

TEST(PoseCommands, ChangeNothingWhereTheyCannot) {
    Document document(hairOnHead(60, 8));
    perform(document, poseOfShape(document.model(), "Rest"));
    perform(document, poseOfShape(document.model(), "Swept"));
    const auto before = contentHash(document.groom());
    EXPECT_FALSE(renamePose(document.model(), "Rest", "Swept"));
    EXPECT_FALSE(renamePose(document.model(), "Wet", "Dry"));
    EXPECT_FALSE(removePose(document.model(), "Wet"));
    EXPECT_FALSE(putPose(document.model(), "Short", std::vector<Vec3f>(3, Vec3f::Zero())));
    std::vector<GroomPose> poses = document.groom().poses;
    poses[0].amount = 7;
    EXPECT_FALSE(setPoses(document.model(), poses));
    poses = document.groom().poses;
    poses.pop_back();
    EXPECT_FALSE(setPoses(document.model(), poses));
    const auto same = setPoses(document.model(), document.groom().poses);
    ASSERT_TRUE(same);
    EXPECT_EQ(*same, nullptr);
    EXPECT_EQ(contentHash(document.groom()), before);
}

/// What changes strands keeps poses in step: as many points, each with its own.
TEST(PoseCommands, StrandsThatGoTakeTheirPosesAlong) {
    Document document(hairOnHead());
    std::vector<Vec3f> other(document.groom().positions().begin(), document.groom().positions().end());
    for (Vec3f& point : other) point.x() += 0.3f * (point.y() - 1.6f);
    perform(document, putPose(document.model(), "Swept", other));
    for (const char* tool : {"delete", "add", "comb"}) {
        ASSERT_TRUE(document.replay(strokeFor(tool))) << tool;
        EXPECT_EQ(document.groom().pointAttributes.view<Vec3f>(poseAttribute("Swept")).size(),
                  document.groom().pointCount())
            << tool;
        for (const Finding& finding : validate(document.groom()))
            EXPECT_NE(finding.severity, Severity::Error) << tool << ": " << finding.what;
        if (std::string_view(tool) == "comb") continue;  // moves hair, and no pose
        const Groom& groom = document.groom();
        const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute("Swept"));
        std::size_t unknown = 0;
        for (std::size_t s = 0; s < groom.strandCount(); ++s) {
            const std::uint32_t first = groom.offsets[s];
            if (shape[first] == shape[first + 1]) {
                ++unknown;
                continue;
            }
            for (std::size_t p = 0; p < groom.strand(s).size(); ++p) {
                Vec3f expected = groom.strand(s)[p];
                expected.x() += 0.3f * (expected.y() - 1.6f);
                EXPECT_LT((shape[first + p] - expected).norm(), 1e-5f) << tool << ": strand " << s;
            }
        }
        // A pose does not know what came later.
        EXPECT_EQ(unknown > 0, std::string_view(tool) == "add") << tool;
    }
}

}  // namespace
}  // namespace hairloom::editing
