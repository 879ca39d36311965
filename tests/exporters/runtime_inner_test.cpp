// SPDX-License-Identifier: GPL-3.0-or-later
// Poses inside a frame, as games give them.

#include <gmock/gmock.h>

#include <array>
#include <limits>

#include "core/simulation/clip_motion.h"
#include "core/simulation/simulation.h"
#include "tests/exporters/character_sample.h"
#include "tests/exporters/levels_sample.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Frame;
using game::Instance;
using testing::HasSubstr;

constexpr float kFrame = 1.0f / 30.0f;
constexpr std::size_t kWithin = 3;

/// A frame that a head nods through, and its quarters; `head` alone moves it.
struct Nod {
    Frame frame{kFrame};
    std::array<float, 12> end{};
    std::array<std::array<float, 12>, kWithin> heads{};
    std::array<game::Pose, kWithin> poses;

    explicit Nod(int f) {
        const auto at = [&](float quarters) {
            const float t = (static_cast<float>(f) + quarters / 4 - 1) * kFrame;
            Eigen::Isometry3f head = Eigen::Isometry3f::Identity();
            head.rotate(Eigen::AngleAxisf(0.4f * std::sin(8 * t), Vec3f::UnitX()));
            head.translation() = Vec3f(0.05f * std::sin(5 * t), 0, 0.02f * t);
            return rows(head.matrix());
        };
        end = at(4);
        for (std::size_t i = 0; i < kWithin; ++i) {
            heads[i] = at(static_cast<float>(i + 1));
            poses[i].head = heads[i].data();
        }
        frame.head = end.data();
        frame.time = static_cast<double>(f) * static_cast<double>(kFrame);
    }
    Nod(const Nod&) = delete;
    Nod& operator=(const Nod&) = delete;
    const Frame& whole() {
        frame.inner = poses.data();
        frame.inner_count = poses.size();
        return frame;
    }
    /// The frames that it stands for.
    Frame part(std::size_t i) const {
        Frame part = frame;
        part.dt = kFrame / 4;
        part.time = frame.time - static_cast<double>(kFrame) * (static_cast<double>(3 - i) / 4);
        part.head = i < kWithin ? heads[i].data() : end.data();
        return part;
    }
};

class RuntimeInner : public RuntimeLevels {};

TEST_F(RuntimeInner, AFrameOfQuartersIsItsFourQuarterFrames) {
    for (const std::uint32_t level : {0u, 1u, 2u, 4u}) {
        Instance whole = another(), quarters = another();
        for (Instance* hair : {&whole, &quarters}) ASSERT_TRUE(hair->setLevel(level));
        for (int f = 1; f <= 20; ++f) {
            Nod nod(f);
            Error error;
            ASSERT_TRUE(whole.step(nod.whole(), &error)) << error.what();
            for (std::size_t i = 0; i <= kWithin; ++i) ASSERT_TRUE(quarters.step(nod.part(i)));
            // A level of one substep in 1/60 s has two in this frame.
            if (whole.describe().asleep == 0 && level < 2) {
                ASSERT_EQ(whole.hash(), quarters.hash()) << "level " << level << ", frame " << f;
            }
        }
        const auto one = guides(whole), other = guides(quarters);
        float farthest = 0;
        for (std::size_t i = 0; i < one.size(); ++i)
            farthest = std::max(farthest, (one[i] - other[i]).norm());
        EXPECT_LT(farthest, level == 2 ? 5e-3f : 1e-6f) << "level " << level;
    }
}

TEST_F(RuntimeInner, FollowsAClipAsTheEditorDoes) {
    const Character made = character();
    bytes_ = written(made.groom);
    Error error;
    ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size(), &error)) << error.what();
    std::vector<std::uint32_t> indices(asset_.describe().bones);
    for (std::uint32_t b = 0; b < indices.size(); ++b) {
        hl_bone bone{};
        ASSERT_EQ(hl_asset_bone(asset_.get(), b, &bone, nullptr), HL_OK);
        indices[b] = bone.index;
    }
    const auto motion = makeClipMotion(made.actor, made.actor->clips().front().name, made.groom).value();
    auto simulation = Simulation::make(made.groom, motion->poseAt(0)).value();
    Instance hair, ends;
    ASSERT_TRUE(hair.make(asset_, HL_GUIDES));
    ASSERT_TRUE(ends.make(asset_, HL_GUIDES));
    const auto bonesOf = [&](const HeadPose& head) {
        std::vector<float> bones;
        for (const std::uint32_t index : indices) {
            const auto matrix = rows(head.bones_ws[index].matrix());
            bones.insert(bones.end(), matrix.begin(), matrix.end());
        }
        return bones;
    };
    std::vector<float> bones = bonesOf(motion->poseAt(0));
    Frame frame(kFrame);
    frame.bones = bones.data();
    frame.bone_count = indices.size();
    ASSERT_TRUE(hair.reset(frame));
    ASSERT_TRUE(ends.reset(frame));
    HeadPose before = motion->poseAt(0);
    float farthest = 0, apart = 0;
    std::vector<float> a, b;
    for (int f = 1; f <= 15; ++f) {
        const float time = static_cast<float>(f) * kFrame;
        HeadStep step = stepOf(*motion, before, time - kFrame, time);
        ASSERT_EQ(step.within.size(), kWithin);
        simulation.step(kFrame, step);
        bones = bonesOf(step.end);
        frame.bones = bones.data();
        std::array<std::vector<float>, kWithin> within;
        std::array<game::Pose, kWithin> poses;
        for (std::size_t i = 0; i < kWithin; ++i) {
            within[i] = bonesOf(step.within[i]);
            poses[i].bones = within[i].data();
        }
        frame.time = static_cast<double>(f) * static_cast<double>(kFrame);
        frame.inner = nullptr;
        frame.inner_count = 0;
        ASSERT_TRUE(ends.step(frame));
        frame.inner = poses.data();
        frame.inner_count = poses.size();
        ASSERT_TRUE(hair.step(frame, &error)) << error.what();
        ASSERT_TRUE(hair.readGuides(a));
        ASSERT_TRUE(ends.readGuides(b));
        for (std::size_t p = 0; p < made.groom.pointCount(); ++p) {
            const Vec3f at = simulation.positions_ws()[p];
            farthest = std::max(farthest, (Vec3f(a[3 * p], a[3 * p + 1], a[3 * p + 2]) - at).norm());
            apart = std::max(apart, (Vec3f(b[3 * p], b[3 * p + 1], b[3 * p + 2]) - at).norm());
        }
        before = std::move(step.end);
    }
    EXPECT_LT(farthest, 0.0005f) << "rest positions and weights are rounded";
    EXPECT_GT(apart, 2 * farthest) << "poses inside are seen";
}

TEST_F(RuntimeInner, OlderFramesMeanWhatTheyMeant) {
    Instance now = another(), before = another();
    for (int f = 1; f <= 5; ++f) {
        Nod nod(f);
        ASSERT_TRUE(now.step(nod.frame));
        Frame old = nod.frame;
        // What an older program has behind its own struct is not looked at.
        old.size = offsetof(hl_frame, inner);
        old.inner = nullptr;
        old.inner_count = 99;
        old.cut = 77;
        ASSERT_TRUE(before.step(old));
        ASSERT_EQ(now.hash(), before.hash());
    }
}

TEST_F(RuntimeInner, ACutDoesNotWhipTheHair) {
    Instance cut = another(), still = another(), whipped = another();
    const auto walked = [](Instance& hair, float x, bool isCut) {
        std::array<float, 12> head = rows(Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
        head[3] = x;
        Frame frame(1.0f / 60);
        frame.head = head.data();
        frame.cut = isCut ? 1 : 0;
        EXPECT_TRUE(hair.step(frame));
    };
    for (Instance* hair : {&cut, &still, &whipped}) {
        for (int f = 0; f < 10; ++f) walked(*hair, 0, false);
    }
    constexpr float kWay = 0.25f;
    walked(still, 0, false);
    walked(cut, kWay, true);
    walked(whipped, kWay, false);
    const auto rest = guides(still), jumped = guides(cut), swept = guides(whipped);
    float off = 0, sweptOff = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const Vec3f there = rest[i] + Vec3f(kWay, 0, 0);
        off = std::max(off, (jumped[i] - there).norm());
        sweptOff = std::max(sweptOff, (swept[i] - there).norm());
    }
    EXPECT_LT(off, 1e-5f);
    EXPECT_GT(sweptOff, 0.01f);
}

TEST_F(RuntimeInner, WrongPosesAreRefusedAndChangeNothing) {
    Instance hair = another();
    Nod nod(1);
    ASSERT_TRUE(hair.step(nod.whole()));
    const std::uint64_t before = hair.hash();
    Error error;
    const auto refused = [&](const Frame& wrong, hl_code code, const char* words) {
        EXPECT_EQ(hl_instance_step(hair.get(), &wrong, &error), code) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        EXPECT_EQ(error.byte, HL_NO_PLACE);
        EXPECT_EQ(hair.hash(), before) << words;
    };
    Frame wrong = nod.whole();
    wrong.inner = nullptr;
    refused(wrong, HL_BAD_VALUE, "there are no poses inside the frame; inner_count says 3");
    for (const std::size_t count : {std::size_t{16}, std::numeric_limits<std::size_t>::max()}) {
        wrong = nod.whole();
        wrong.inner_count = count;
        refused(wrong, HL_WRONG_SIZE, "poses inside the frame; expected at most 15");
    }
    wrong = nod.whole();
    wrong.cut = 2;
    refused(wrong, HL_BAD_VALUE, "cut is 2; expected 0 or 1");
    nod.poses[1].head = nullptr;
    refused(nod.whole(), HL_BAD_VALUE, "pose 2 of 3 inside the frame has no head, which the frame has");
    nod.poses[1].head = nod.heads[1].data();
    nod.poses[2].roots = nod.heads[0].data();
    refused(nod.whole(), HL_BAD_VALUE, "pose 3 of 3 inside the frame has roots, which the frame has not");
    nod.poses[2].roots = nullptr;
    nod.poses[0].size = 4;
    refused(nod.whole(), HL_WRONG_SIZE, "hl_pose");
    nod.poses[0].size = sizeof(hl_pose);
    nod.poses[2].size = 8192;
    refused(nod.whole(), HL_WRONG_SIZE, "pose 3 of 3 inside the frame says that it has 8192 bytes");
    nod.poses[2].size = sizeof(hl_pose);
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        nod.heads[1][7] = bad;
        refused(nod.whole(), HL_BAD_VALUE, "pose 2 of 3 inside the frame has a matrix that is not finite");
    }
    nod.heads[1][7] = 0;
    EXPECT_TRUE(hair.step(nod.whole(), &error)) << error.what();
    EXPECT_NE(hair.hash(), before);
    hl_pose_init(nullptr);
}

TEST_F(RuntimeInner, AskForMemoryOnceOrNotAfterReserve) {
    for (const bool reserves : {false, true}) {
        Instance hair = another();
        if (reserves) {
            hl_reserve wanted;
            hl_reserve_init(&wanted);
            wanted.inner = kWithin;
            ASSERT_EQ(hl_instance_reserve(hair.get(), &wanted, nullptr), HL_OK);
        }
        std::size_t first = 0, later = 0;
        for (int f = 1; f <= 10; ++f) {
            Nod nod(f);
            const Frame& frame = nod.whole();
            const std::size_t before = runtime::allocationCount();
            ASSERT_TRUE(hair.step(frame));
            (f == 1 ? first : later) += runtime::allocationCount() - before;
        }
        if (reserves) {
            EXPECT_EQ(first, 0u);
        }
        EXPECT_EQ(later, 0u);
    }
    Instance hair = another();
    hl_reserve wanted;
    hl_reserve_init(&wanted);
    wanted.inner = 16;
    Error error;
    EXPECT_EQ(hl_instance_reserve(hair.get(), &wanted, &error), HL_BAD_VALUE);
    EXPECT_THAT(error.words, HasSubstr("reserve.inner is 16; expected 0 to 15"));
}

TEST_F(RuntimeInner, SleepersStayAsleepWhereTheHeadStays) {
    Groom groom = this->hair();
    groom.simulation.windSpeed = 0;
    bytes_ = written(groom);
    ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size()));
    Instance hair;
    ASSERT_TRUE(hair.make(asset_, HL_GUIDES));
    std::array<float, 12> head = rows(Eigen::Matrix4f(Eigen::Matrix4f::Identity())), moved = head;
    std::array<game::Pose, kWithin> poses;
    for (game::Pose& pose : poses) pose.head = head.data();
    Frame frame(kFrame);
    frame.head = head.data();
    frame.inner = poses.data();
    frame.inner_count = poses.size();
    for (int f = 0; f < 400; ++f) ASSERT_TRUE(hair.step(frame));
    ASSERT_EQ(hair.describe().asleep, hair.describe().guides);
    moved[3] = 0.01f;
    poses[1].head = moved.data();
    ASSERT_TRUE(hair.step(frame));
    EXPECT_EQ(hair.describe().asleep, 0u) << "it moves within the frame alone";
}

}  // namespace
}  // namespace hairloom::test
