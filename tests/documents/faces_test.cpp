// SPDX-License-Identifier: GPL-3.0-or-later
// A face whose clip moves morph targets: roots stay on its skin, on every frame, on both engines, in blends
// of clips and wherever it is scrubbed to.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/output_file.h"
#include "core/base/smooth_step.h"
#include "core/documents/head_import.h"
#include "core/documents/motions.h"
#include "core/simulation/simulation.h"
#include "core/simulation/time_line_motion.h"
#include "tests/documents/talking_groom.h"

namespace hairloom::test {
namespace {

constexpr float kFrame = 1.0f / 60;
/// What is asked for is 0.1 mm.
constexpr double kOnSkin = 2e-5;

class Faces : public testing::Test {
  protected:
    std::unique_ptr<HeadMotion> motion(const std::string& name) {
        auto made = makeMotion(name, {}, face.groom);
        EXPECT_TRUE(made) << made.error().message();
        return std::move(*made);
    }
    TalkingGroom face;
};

TEST_F(Faces, RootsStayOnTheSkinOnEveryFrame) {
    const auto talk = motion("clip:talk");
    auto simulation = Simulation::make(face.groom, talk->poseAt(0), {});
    ASSERT_TRUE(simulation) << simulation.error().message();
    HeadPose pose = talk->poseAt(0);
    double farthest = 0;
    for (int f = 1; f <= 60; ++f) {
        const float time = kFrame * static_cast<float>(f);
        HeadStep step = stepOf(*talk, pose, time - kFrame, time);
        simulation->step(kFrame, step);
        pose = std::move(step.end);
        // A clip plays in a loop: its last frame is its first.
        const FaceAt now = talkAt(f == 60 ? 0.0 : f / 60.0);
        EXPECT_LT(face.offSkin(simulation->positions_ws(), now), kOnSkin) << f;
        farthest = std::max(farthest, face.offSkin(simulation->positions_ws(), {0, 0, now.radians}));
    }
    EXPECT_GT(farthest, 0.01) << "morph targets move the skin";
}

TEST_F(Faces, WeightsBlendBetweenTwoClipsOfATimeLine) {
    TimeLine clips;
    clips.clips.resize(2);
    clips.clips[0].name = "talk";
    clips.clips[1].name = "frown";
    clips.clips[1].start = 0.5f;
    clips.clips[1].blend = 0.25f;
    face.groom.timeLine = std::make_shared<const TimeLine>(clips);
    const auto line = motion("timeline");
    for (int f = 59; f >= 0; --f) {
        const double time = f / 60.0;
        FaceAt now = talkAt(time);
        if (time >= 0.5)
            now = between(now, frownAt(time - 0.5), smoothStep(std::min((time - 0.5) / 0.25, 1.0)));
        const HeadPose pose = line->poseAt(static_cast<float>(time));
        EXPECT_LT(face.offSkin(face.rootsAt(pose), now), kOnSkin) << f;
    }
}

TEST_F(Faces, AClipWithoutWeightsLeavesNothingToPay) {
    const auto nod = motion("clip:nod_and_turn");
    const HeadPose pose = nod->poseAt(0.4f);
    EXPECT_TRUE(pose.morphed_ss.empty());
    const auto plain = loadActor(bustFile(), face.groom);
    ASSERT_TRUE(plain) << plain.error().message();
    const auto same = makeMotion("clip:nod_and_turn", bustFile(), face.groom);
    ASSERT_TRUE(same) << same.error().message();
    EXPECT_EQ((*same)->poseAt(0.4f).scalpPositions_ws, pose.scalpPositions_ws);
}

TEST_F(Faces, AHeadWithoutSomeGroupsMorphsAsTheWholeDoes) {
    HeadImportOptions options;
    options.leaveOut = {"bust_shoulders"};
    const auto part = importHead(face.file, options);
    ASSERT_TRUE(part) << part.error().message();
    Groom groom;
    groom.scalp = std::make_shared<const ScalpMesh>(part->scene.mesh);
    groom.characterFile = face.file;
    ASSERT_LT(groom.scalp->triangleCount(), face.groom.scalp->triangleCount());
    const auto talk = makeMotion("clip:talk", {}, groom);
    ASSERT_TRUE(talk) << talk.error().message();
    const auto actor = loadActor({}, groom);
    ASSERT_TRUE(actor);
    for (const float time : {0.1f, 0.6f}) {
        const HeadPose pose = (*talk)->poseAt(time);
        for (std::size_t v = 0; v < groom.scalp->vertexCount(); ++v) {
            const Vec3d rest = groom.scalp->positions()[v].cast<double>();
            const Vec3d skin = skinAt(rest, weightOf(**actor, v, "head"), talkAt(time));
            ASSERT_LT((pose.scalpPositions_ws[v].cast<double>() - skin).norm(), kOnSkin) << v;
        }
    }
}

}  // namespace
}  // namespace hairloom::test
