// SPDX-License-Identifier: GPL-3.0-or-later
// Crowds: what is promised is kept, and the same frames come to the same bits.

#include <gmock/gmock.h>

#include <chrono>
#include <limits>

#include "tests/exporters/levels_sample.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Instance;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class RuntimeCrowd : public RuntimeLevels {};

TEST_F(RuntimeCrowd, ACrowdKeepsTheErrorInPixels) {
    Crowd crowd(first_, 8), exact(first_, 8);
    crowd.limits.error_pixels = 2;
    exact.limits.error_pixels = 0;
    std::array<bool, HL_LEVEL_COUNT> seen{};
    int over = 0;
    for (int f = 1; f <= 180; ++f) {
        crowd.step(f);
        exact.step(f);
        EXPECT_EQ(crowd.report.within, 1u);
        for (std::size_t c = 0; c < crowd.hair.size(); ++c) {
            const hl_viewed& viewed = crowd.viewed[c];
            EXPECT_EQ(exact.viewed[c].level, HL_LEVEL_FINEST);
            EXPECT_LE(viewed.error_pixels, 2);
            seen[viewed.level] = true;
            const float apart = rootMeanSquare(guides(crowd.hair[c]), guides(exact.hair[c]));
            over += apart * viewed.pixels_per_metre > 2;
        }
    }
    EXPECT_LE(over, 180 * 8 / 50) << "of 1440 frames of a character";
    EXPECT_GE(std::ranges::count(seen, true), 3) << "levels in use";
}

TEST_F(RuntimeCrowd, ABudgetIsKeptAndSpreadByPredictedError) {
    Crowd rich(first_, 8), poor(first_, 8);
    rich.limits.error_pixels = poor.limits.error_pixels = 0.25f;
    float most = 0;
    for (int f = 1; f <= 60; ++f) {
        rich.step(f);
        most = rich.report.milliseconds;
    }
    poor.limits.milliseconds = 0.5f * most;
    for (int f = 1; f <= 60; ++f) {
        poor.step(f);
        EXPECT_LE(poor.report.milliseconds, poor.limits.milliseconds);
        float sum = 0;
        for (const hl_viewed& viewed : poor.viewed) {
            sum += viewed.milliseconds;
            EXPECT_LE(viewed.error_pixels, poor.report.error_pixels);
        }
        EXPECT_FLOAT_EQ(sum, poor.report.milliseconds);
    }
    EXPECT_GT(poor.report.error_pixels, 0.25f);
    EXPECT_EQ(poor.report.within, 0u) << "the error is larger than was asked for";
    // Twice as fast a machine has room for twice as much.
    const float before = poor.report.error_pixels;
    poor.limits.speed = 2;
    poor.step(61);
    EXPECT_LT(poor.report.error_pixels, before);
    // Nothing at all: all are rigid, and that is said.
    poor.limits.milliseconds = 0;
    poor.step(62);
    EXPECT_EQ(poor.report.within, 0u);
    EXPECT_TRUE(std::ranges::all_of(poor.viewed, [](const auto& v) { return v.level == HL_LEVEL_RIGID; }));
}

TEST_F(RuntimeCrowd, TheSameFramesComeToTheSameBits) {
    Crowd one(first_, 6), two(first_, 6);
    one.limits.milliseconds = two.limits.milliseconds = 0.15f;
    std::vector<std::uint32_t> changes(6);
    for (int f = 1; f <= 120; ++f) {
        one.step(f);
        two.step(f);
        for (std::size_t c = 0; c < 6; ++c) {
            ASSERT_EQ(one.viewed[c].level, two.viewed[c].level) << f;
            ASSERT_EQ(one.hair[c].hash(), two.hair[c].hash()) << f;
            ASSERT_EQ(one.viewed[c].error_pixels, two.viewed[c].error_pixels) << f;
        }
        if (f == 60) {
            // A copy is a snapshot at any level.
            for (std::size_t c = 0; c < 6; ++c) {
                ASSERT_TRUE(two.hair[c].copy(one.hair[c]));
                two.viewed[c].hair = two.hair[c].get();
            }
        }
    }
    EXPECT_EQ(guides(one.hair[3]), guides(two.hair[3]));
}

TEST_F(RuntimeCrowd, WhatSleepsOrIsNotSeenCostsNothing) {
    Crowd crowd(first_, 5);
    const auto rest = [&](int frames) {
        for (int f = 0; f < frames; ++f) {
            for (Instance& hair : crowd.hair) ASSERT_TRUE(hair.step(Walk(0, 0, 0).frame));
        }
    };
    rest(200);
    for (hl_viewed& viewed : crowd.viewed) viewed.pixels_per_metre = 500;
    crowd.limits.error_pixels = 0;
    ASSERT_EQ(hl_crowd_plan(&crowd.limits, crowd.viewed.data(), 5, &crowd.report, nullptr), HL_OK);
    rest(200);
    ASSERT_EQ(hl_crowd_plan(&crowd.limits, crowd.viewed.data(), 5, &crowd.report, nullptr), HL_OK);
    EXPECT_EQ(crowd.report.milliseconds, 0);
    for (const Instance& hair : crowd.hair) EXPECT_EQ(hair.describe().asleep, hair.describe().guides);
    ASSERT_TRUE(crowd.hair[0].step(Walk(20).frame));
    EXPECT_LT(crowd.hair[0].describe().asleep, crowd.hair[0].describe().guides) << "it wakes";
    for (hl_viewed& viewed : crowd.viewed) viewed.pixels_per_metre = 0;
    ASSERT_EQ(hl_crowd_plan(&crowd.limits, crowd.viewed.data(), 5, nullptr, nullptr), HL_OK);
    EXPECT_EQ(crowd.viewed[0].level, HL_LEVEL_RIGID);
}

TEST_F(RuntimeCrowd, SleepingHairTakesAHundredthOfHairThatMoves) {
    using Clock = std::chrono::steady_clock;
    const auto quickest = [](Crowd& crowd, const Walk& walk) {
        crowd.limits.error_pixels = 0;
        for (hl_viewed& viewed : crowd.viewed) viewed.pixels_per_metre = 500;
        // The quickest of some: other work on this machine falls on the others.
        double milliseconds = 1e9;
        for (int i = 0; i < 10; ++i) {
            const auto begin = Clock::now();
            EXPECT_EQ(hl_crowd_plan(&crowd.limits, crowd.viewed.data(), 50, nullptr, nullptr), HL_OK);
            for (Instance& hair : crowd.hair) EXPECT_TRUE(hair.step(walk.frame));
            milliseconds = std::min(milliseconds,
                                    std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
        }
        return milliseconds;
    };
    Crowd awake(first_, 50);
    Instance sleeper = another();
    for (int f = 1; f < 400; ++f) ASSERT_TRUE(sleeper.step(Walk(0, 0, 0).frame));
    ASSERT_EQ(sleeper.describe().asleep, sleeper.describe().guides);
    Crowd asleep(sleeper, 50);
    const double moving = quickest(awake, Walk(5)), resting = quickest(asleep, Walk(0, 0, 0));
    EXPECT_EQ(asleep.hair[49].describe().asleep, sleeper.describe().guides);
    EXPECT_LT(resting, 0.01 * moving);
}

TEST_F(RuntimeCrowd, PlansLevelsAndStepsTakeNoMemory) {
    Crowd crowd(first_, 4);
    for (int f = 1; f <= 30; ++f) crowd.step(f);  // until effects have what they need
    for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
        hl_instance_set_level(crowd.hair[0].get(), l, 1, nullptr);
        for (int f = 1; f <= 5; ++f) ASSERT_TRUE(crowd.hair[0].step(Walk(f).frame));
    }
    const std::size_t before = runtime::allocationCount();
    for (int f = 31; f <= 60; ++f) crowd.step(f);
    for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
        hl_instance_set_level(crowd.hair[0].get(), l, 1, nullptr);
        crowd.hair[0].step(Walk(60).frame);
    }
    EXPECT_EQ(runtime::allocationCount() - before, 0u);
}

TEST_F(RuntimeCrowd, WrongWordsAreRefusedAndChangeNothing) {
    Crowd crowd(first_, 2);
    Error error;
    const auto refused = [&](const hl_crowd_limits& limits, hl_code code, const char* words) {
        EXPECT_EQ(hl_crowd_plan(&limits, crowd.viewed.data(), 2, nullptr, &error), code) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        EXPECT_EQ(crowd.viewed[0].level, 0u);
    };
    hl_crowd_limits wrong = crowd.limits;
    wrong.size = 8;
    refused(wrong, HL_WRONG_SIZE, "hl_crowd_limits");
    for (const float value : {-1.0f, kNaN, kInfinity}) {
        wrong = crowd.limits;
        wrong.error_pixels = value;
        refused(wrong, HL_BAD_VALUE, "error_pixels");
        wrong = crowd.limits;
        wrong.speed = value;
        refused(wrong, HL_BAD_VALUE, "speed");
        crowd.viewed[1].pixels_per_metre = value;
        refused(crowd.limits, HL_BAD_VALUE, "character 1 pixels_per_metre");
        crowd.viewed[1].pixels_per_metre = 1;
    }
    wrong = crowd.limits;
    wrong.milliseconds = kNaN;
    refused(wrong, HL_BAD_VALUE, "milliseconds");
    Instance plain;
    ASSERT_TRUE(plain.make(asset_, HL_GUIDES));
    for (hl_instance* const none : {static_cast<hl_instance*>(nullptr), plain.get()}) {
        crowd.viewed[1].hair = none;
        refused(crowd.limits, HL_BAD_VALUE, "character 1 has no instance");
    }
    EXPECT_EQ(hl_crowd_plan(nullptr, crowd.viewed.data(), 2, nullptr, nullptr), HL_BAD_VALUE);
    EXPECT_EQ(hl_crowd_plan(&crowd.limits, nullptr, 2, nullptr, nullptr), HL_BAD_VALUE);
    hl_crowd_report report{9, 9, 9};
    EXPECT_EQ(hl_crowd_plan(&crowd.limits, nullptr, 0, &report, nullptr), HL_OK) << "nobody is a crowd, too";
    EXPECT_EQ(report.milliseconds, 0);
    EXPECT_EQ(report.within, 1u);
    hl_level described;
    EXPECT_EQ(hl_instance_level(plain.get(), 0, &described, &error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_level(first_.get(), HL_LEVEL_COUNT, &described, &error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_set_level(plain.get(), 0, 1, &error), HL_BAD_VALUE);
    for (const float share : {0.0f, -1.0f, 1.5f, kNaN})
        EXPECT_EQ(hl_instance_set_level(first_.get(), 1, share, &error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_set_level(first_.get(), HL_LEVEL_COUNT, 1, &error), HL_BAD_VALUE);
}

}  // namespace
}  // namespace hairloom::test
