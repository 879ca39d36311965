// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of the runtime asset as games play them.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/simulation/simulation.h"
#include "hairloom/gpu.h"
#include "tests/exporters/posed_hair.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Instance;
using testing::HasSubstr;

TEST_F(RuntimePoses, PlayAsInTheToolWithKeyedAmounts) {
    const Groom groom = posed();
    open(groom);
    // As the tool has it, on the strands of the file: what quantising moves is looked at elsewhere.
    const auto rest = runtime::Asset::open(bytes_).asset->strandsAtRest();
    Groom quantised = groom;
    auto& positions = quantised.pointAttributes.edit<Vec3f>(attribute::kPosition);
    for (std::size_t p = 0; p < positions.size(); ++p)
        positions[p] = Vec3f(rest.positions_ss[p].x, rest.positions_ss[p].y, rest.positions_ss[p].z);
    auto tool = Simulation::make(quantised, {});
    auto authored = Simulation::make(groom, {});
    ASSERT_TRUE(tool) << tool.error().message();
    float most = 0, mostOfAuthored = 0, way = 0;
    for (int f = 1; f <= 120; ++f) {
        // One comes and goes, the other joins it.
        const float t = static_cast<float>(f) / 120;
        const std::vector<float> amounts{std::max(0.0f, std::sin(6.3f * t)), t < 0.3f ? 0.0f : t};
        const Walk walk(f);
        HeadPose pose;
        for (int i = 0; i < 12; ++i)
            pose.head_ws.matrix()(i / 4, i % 4) = walk.head[static_cast<std::size_t>(i)];
        pose.wind_ws = Vec3f(walk.wind[0], walk.wind[1], walk.wind[2]);
        pose.poseAmounts = amounts;
        tool->step(1 / 60.0f, pose);
        authored->step(1 / 60.0f, pose);
        for (std::uint32_t k = 0; k < 2; ++k) ASSERT_TRUE(hair_.setPose(k, amounts[k]));
        ASSERT_TRUE(hair_.step(walk.frame));
        const std::vector<Vec3f> played = guides(hair_);
        most = std::max(most, farthest(played, tool->positions_ws()));
        mostOfAuthored = std::max(mostOfAuthored, farthest(played, authored->positions_ws()));
        way = std::max(way, farthest(played, groom.positions()));
    }
    EXPECT_GT(way, 0.05f);
    EXPECT_LT(most, 0.0002f);
    EXPECT_LT(mostOfAuthored, 0.0005f);
    RecordProperty("farthest_mm", static_cast<int>(1000 * most));
}

TEST_F(RuntimePoses, HoldHairAtEveryLevel) {
    Groom groom = posed();
    open(groom, HL_GUIDES | HL_LEVELS);
    const auto opened = runtime::Asset::open(bytes_);
    const auto rest = opened.asset->strandsAtRest();
    const auto pose = opened.asset->poseArrays(0, rest);
    std::vector<Vec3f> expected;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        // The first segment goes with the root.
        for (std::uint32_t p = rest.offsets[s]; p < rest.offsets[s + 1]; ++p) {
            const auto at = [](const runtime::Float3& v) { return Vec3f(v.x, v.y, v.z); };
            const std::uint32_t first = rest.offsets[s];
            expected.push_back(p < first + 2 ? at(rest.positions_ss[p])
                                             : Vec3f(expected.back() + at(pose.positions_ss[p]) -
                                                     at(pose.positions_ss[p - 1])));
        }
    }
    for (std::uint32_t level = 0; level < HL_LEVEL_COUNT; ++level) {
        Instance one;
        ASSERT_TRUE(one.copy(hair_));
        ASSERT_TRUE(one.setLevel(level));
        ASSERT_TRUE(one.setPose(0, 1));
        play(one, 0, 150, 0);
        // Coarser ones have fewer corners on each strand.
        const float allowed = level == HL_LEVEL_FINEST || level == HL_LEVEL_RIGID ? 0.0005f : 0.004f;
        EXPECT_LT(farthest(guides(one), expected), allowed) << level;
        EXPECT_GT(farthest(guides(hair_), expected), 0.05f);
        // Half way there is between.
        ASSERT_TRUE(one.setPose(0, 0.5f));
        play(one, 0, 150, 0);
        const float left = farthest(guides(one), expected);
        EXPECT_GT(left, 0.005f) << level;
        EXPECT_LT(left, 0.12f) << level;
        // Going to another moves nothing at once.
        const std::vector<Vec3f> before = guides(one);
        ASSERT_TRUE(one.setLevel((level + 1) % HL_LEVEL_COUNT));
        EXPECT_LT(farthest(guides(one), before), 1e-5f) << level;
        ASSERT_TRUE(one.setPose(0, 0));
        play(one, 0, 200, 0);
        EXPECT_GT(farthest(guides(one), expected), 0.03f) << "it is let go";
        EXPECT_LE(one.describe().bytes, asset_.describe().guides_memory + asset_.describe().levels_memory);
    }
}

TEST_F(RuntimePoses, OfGuidesThatAreNotSimulatedHaveTheirOwnMask) {
    Groom groom = posed();
    open(groom, HL_GUIDES | HL_LEVELS);
    const std::vector<float> weights = poseWeights(groom, groom.poses[1]);
    for (const std::uint32_t level : {3u, 4u}) {
        Instance one, still;
        ASSERT_TRUE(one.copy(hair_));
        ASSERT_TRUE(still.copy(hair_));
        for (Instance* hair : {&one, &still}) ASSERT_TRUE(hair->setLevel(level));
        ASSERT_TRUE(one.setPose(1, 1));
        for (Instance* hair : {&one, &still}) play(*hair, 0, 150, 0);
        const std::vector<Vec3f> a = guides(one), b = guides(still);
        float masked = 0, others = 0;
        for (std::size_t p = 0; p < a.size(); ++p) {
            float& most = weights[p] > 0 ? masked : others;
            most = std::max(most, (a[p] - b[p]).norm());
        }
        EXPECT_GT(masked, 0.03f) << level;
        // Neighbours that follow a pose fall less than hair that does not, which takes over their fall.
        EXPECT_LT(others, level == HL_LEVEL_RIGID ? 1e-6f : 0.6f * masked) << level;
    }
}

TEST_F(RuntimePoses, AreSavedCopiedAndWakeHair) {
    open(posed(), HL_GUIDES | HL_LEVELS);
    for (std::uint32_t level = 0; level < HL_LEVEL_COUNT; ++level) {
        Instance one, two, copy;
        ASSERT_TRUE(one.copy(hair_));
        ASSERT_TRUE(one.setLevel(level));
        play(one, 1, 6);
        ASSERT_TRUE(one.setPose(0, 0.7f));
        play(one, 6, 9);
        ASSERT_TRUE(one.setPose(1, 0.3f));  // asked for, and not stepped yet
        const std::vector<std::byte> bytes = saved(one);
        ASSERT_TRUE(two.make(asset_, HL_GUIDES | HL_LEVELS));
        Error error;
        ASSERT_EQ(hl_instance_load(two.get(), bytes.data(), bytes.size(), &error), HL_OK) << error.what();
        ASSERT_TRUE(copy.copy(one));
        float amount = 0;
        ASSERT_EQ(hl_instance_pose(two.get(), 1, &amount, nullptr), HL_OK);
        EXPECT_EQ(amount, 0.3f);
        for (int f = 9; f < 20; ++f) {
            for (Instance* hair : {&one, &two, &copy}) play(*hair, f, f + 1);
            ASSERT_EQ(one.hash(), two.hash()) << level << " " << f;
            ASSERT_EQ(one.hash(), copy.hash()) << level << " " << f;
            ASSERT_EQ(guides(one), guides(two)) << level << " " << f;
        }
        // Back to what it was, with no pose.
        Instance off;
        ASSERT_TRUE(off.copy(hair_));
        const std::vector<std::byte> plain = saved(off);
        ASSERT_EQ(hl_instance_load(one.get(), plain.data(), plain.size(), &error), HL_OK) << error.what();
        EXPECT_EQ(one.hash(), off.hash());
    }
}

TEST_F(RuntimePoses, WakeHairThatSleeps) {
    Groom groom = dome(10, 1, 16, 0.18f);
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}};
    ASSERT_TRUE(putPose(groom, "Swept", turned(groom, Vec3f::UnitX(), 0.5f)));
    open(groom);
    play(hair_, 1, 20);
    for (int f = 0; f < 600; ++f) play(hair_, 0, 1, 0);
    ASSERT_EQ(hair_.describe().asleep, hair_.describe().guides);
    const std::vector<Vec3f> before = guides(hair_);
    ASSERT_TRUE(hair_.setPose(0, 0));
    play(hair_, 0, 1, 0);
    EXPECT_EQ(hair_.describe().asleep, hair_.describe().guides) << "as it was";
    ASSERT_TRUE(hair_.setPose(0, 1));
    play(hair_, 0, 60, 0);
    EXPECT_GT(farthest(guides(hair_), before), 0.03f);
}

TEST_F(RuntimePoses, AskForNoMemoryOnceTheyAreReserved) {
    open(posed(), HL_GUIDES | HL_LEVELS);
    Instance with, without;
    ASSERT_TRUE(with.copy(hair_));
    ASSERT_TRUE(without.copy(hair_));
    hl_reserve reserve;
    hl_reserve_init(&reserve);
    reserve.poses = 2;
    Error error;
    EXPECT_EQ(hl_instance_reserve(with.get(), &reserve, &error), HL_BAD_VALUE);
    EXPECT_THAT(error.words, HasSubstr("reserve.poses"));
    reserve.poses = 1;
    ASSERT_EQ(hl_instance_reserve(with.get(), &reserve, &error), HL_OK) << error.what();
    const auto asked = [](Instance& hair) {
        const std::size_t from = runtime::allocationCount();
        for (int f = 1; f < 60; ++f) {
            if (f % 7 == 0) {
                EXPECT_TRUE(hair.setLevel(static_cast<std::uint32_t>(f / 7) % HL_LEVEL_COUNT));
            }
            const float amount = f % 20 < 10 ? 0.05f * static_cast<float>(f % 20) : 0.0f;
            EXPECT_TRUE(hair.setPose(0, amount));
            EXPECT_TRUE(hair.setPose(1, f % 3 == 0 ? amount : 0.0f));
            EXPECT_TRUE(hair.step(Walk(f).frame));
        }
        return runtime::allocationCount() - from;
    };
    EXPECT_EQ(asked(with), 0u);
    EXPECT_GT(asked(without), 0u) << "else this test looks at nothing";
    EXPECT_EQ(with.hash(), without.hash());
}

TEST_F(RuntimePoses, AreNotSteppedOnAGpu) {
    open(posed());
    Error error;
    ASSERT_TRUE(hair_.setPose(0, 0.5f));
    EXPECT_EQ(hl_gpu_begin(hair_.get(), &error), HL_BAD_VALUE);
    EXPECT_THAT(error.words, HasSubstr("poses"));
    ASSERT_TRUE(hair_.setPose(0, 0));
    ASSERT_EQ(hl_gpu_begin(hair_.get(), &error), HL_OK) << error.what();
    const Walk walk(1);
    ASSERT_EQ(hl_gpu_step(hair_.get(), &walk.frame, &error), HL_OK) << error.what();
    ASSERT_TRUE(hair_.setPose(0, 0.5f));
    EXPECT_EQ(hl_gpu_step(hair_.get(), &walk.frame, &error), HL_BAD_VALUE);
}

}  // namespace
}  // namespace hairloom::test
