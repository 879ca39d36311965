// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail and crowds: what is predicted holds, what is promised is kept, and the same frames come to
// the same bits.

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_samples.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Asset;
using game::Error;
using game::Frame;
using game::Instance;
using game::kNothing;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A character that nods about its neck and walks to and fro.
struct Walk {
    std::array<float, 12> head{};
    std::array<float, 3> wind{};
    Frame frame;

    explicit Walk(int f, double late = 0, float still = 1) {
        const double t = f / 60.0 + late;
        const auto angle = still * static_cast<float>(0.3 * std::sin(6 * t));
        const float c = std::cos(angle), s = std::sin(angle);
        head = {c, 0, s, still * static_cast<float>(0.2 * std::sin(3 * t)), 0, 1, 0, 0, -s, 0, c, 0};
        wind = {still * static_cast<float>(1.5 + std::sin(2 * t)), 0, still * 0.5f};
        frame.time = t;
        frame.head = head.data();
        frame.wind = wind.data();
    }
};

class RuntimeLevels : public AssetTest {
  protected:
    void SetUp() override {
        AssetTest::SetUp();
        Groom groom = dome(10, 1, 16, 0.18f);
        groom.interpolation.followPerGuide = 20;
        groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.095f, ""}};
        bytes_ = written(groom);
        ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size()));
        ASSERT_TRUE(first_.make(asset_, HL_GUIDES | HL_LEVELS));
    }
    Instance another() const {
        Instance copy;
        EXPECT_TRUE(copy.copy(first_));
        return copy;
    }
    static std::vector<Vec3f> guides(const Instance& hair) {
        std::vector<Vec3f> points(hair.describe().guide_points);
        const hl_out out{points.data(), points.size() * sizeof(Vec3f), sizeof(Vec3f)};
        EXPECT_EQ(hl_instance_read_guides(hair.get(), out, kNothing, kNothing, nullptr), HL_OK);
        return points;
    }
    static float rootMeanSquare(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
        double sum = 0;
        for (std::size_t p = 0; p < a.size(); ++p) sum += static_cast<double>((a[p] - b[p]).squaredNorm());
        return static_cast<float>(std::sqrt(sum / static_cast<double>(a.size())));
    }
    static hl_level level(const Instance& hair, std::uint32_t number) {
        hl_level level{};
        EXPECT_EQ(hl_instance_level(hair.get(), number, &level, nullptr), HL_OK);
        return level;
    }

    std::vector<std::byte> bytes_;
    Asset asset_;
    Instance first_;
};

/// Characters side by side, each farther off than the one before, and planned each frame.
struct Crowd {
    std::vector<Instance> hair;
    std::vector<hl_viewed> viewed;
    hl_crowd_limits limits{};
    hl_crowd_report report{};

    Crowd(const Instance& first, std::size_t count) : hair(count), viewed(count) {
        hl_crowd_limits_init(&limits);
        for (std::size_t c = 0; c < count; ++c) {
            EXPECT_TRUE(hair[c].copy(first));
            viewed[c].hair = hair[c].get();
        }
    }
    void step(int f) {
        for (std::size_t c = 0; f == 1 && c < hair.size(); ++c)
            ASSERT_TRUE(hair[c].reset(Walk(0, 0.3 * static_cast<double>(c)).frame));
        for (std::size_t c = 0; c < hair.size(); ++c)
            viewed[c].pixels_per_metre =
                2000 / (1 + static_cast<float>(c) + 0.5f * std::sin(0.05f * static_cast<float>(f)));
        hl_error error{};
        ASSERT_EQ(hl_crowd_plan(&limits, viewed.data(), viewed.size(), &report, &error), HL_OK)
            << error.words;
        for (std::size_t c = 0; c < hair.size(); ++c)
            ASSERT_TRUE(hair[c].step(Walk(f, 0.3 * static_cast<double>(c)).frame));
    }
};

TEST_F(RuntimeLevels, TheFinestHasTheBitsOfHairWithoutLevels) {
    Instance plain, hair = another();
    ASSERT_TRUE(plain.make(asset_, HL_GUIDES));
    for (int f = 1; f <= 40; ++f) {
        ASSERT_TRUE(plain.step(Walk(f).frame));
        ASSERT_TRUE(hair.step(Walk(f).frame));
        ASSERT_EQ(plain.hash(), hair.hash());
    }
    EXPECT_EQ(guides(plain), guides(hair));
}

TEST_F(RuntimeLevels, GoingToAnotherMovesNothingAtOnceAndFadesOver) {
    for (std::uint32_t from = 0; from < HL_LEVEL_COUNT; ++from) {
        for (std::uint32_t to = 0; to < HL_LEVEL_COUNT; ++to) {
            Instance hair = another(), settled = another();
            ASSERT_EQ(hl_instance_set_level(hair.get(), from, 1, nullptr), HL_OK);
            ASSERT_EQ(hl_instance_set_level(settled.get(), to, 1, nullptr), HL_OK);
            for (int f = 1; f <= 30; ++f) ASSERT_TRUE(hair.step(Walk(f).frame));
            for (int f = 1; f <= 120; ++f) ASSERT_TRUE(settled.step(Walk(f).frame));
            std::vector<Vec3f> before = guides(hair);
            ASSERT_EQ(hl_instance_set_level(hair.get(), to, 1, nullptr), HL_OK);
            EXPECT_LT(rootMeanSquare(before, guides(hair)), 1e-6f) << from << " to " << to;
            float jump = 0;
            for (int f = 31; f <= 120; ++f) {
                ASSERT_TRUE(hair.step(Walk(f).frame));
                const std::vector<Vec3f> now = guides(hair);
                if (f < 40) jump = std::max(jump, rootMeanSquare(before, now));
                before = now;
            }
            EXPECT_LT(jump, 0.02f) << "metres in a frame, " << from << " to " << to;
            EXPECT_LT(rootMeanSquare(before, guides(settled)), 0.005f) << from << " to " << to;
        }
    }
}

TEST_F(RuntimeLevels, CoarserOnesAreCheaperAndAsFarOffAsPredicted) {
    Instance exact = another();
    std::vector<Instance> hair(HL_LEVEL_COUNT);
    for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
        hair[l] = another();
        ASSERT_EQ(hl_instance_set_level(hair[l].get(), l, 1, nullptr), HL_OK);
        const hl_level now = level(first_, l);
        if (l == 0) {
            EXPECT_EQ(now.guides, first_.describe().guides);
            EXPECT_EQ(now.error_still + now.error_head + now.error_wind, 0);
            continue;
        }
        const hl_level before = level(first_, l - 1);
        EXPECT_LT(now.milliseconds, 0.8f * before.milliseconds) << l;
        EXPECT_LE(now.guides, 0.6 * before.guides) << l;
        EXPECT_GE(now.error_head, before.error_head) << l;
        EXPECT_GT(now.error_head + now.error_wind, 0) << l;
    }
    EXPECT_EQ(level(first_, HL_LEVEL_RIGID).points, 0u);
    std::array<double, HL_LEVEL_COUNT> measured{}, predicted{};
    for (int f = 1; f <= 240; ++f) {
        ASSERT_TRUE(exact.step(Walk(f).frame));
        for (std::uint32_t l = 1; l < HL_LEVEL_COUNT; ++l) {
            ASSERT_TRUE(hair[l].step(Walk(f).frame));
            if (f < 30) continue;  // until it has come into motion
            measured[l] += static_cast<double>(rootMeanSquare(guides(exact), guides(hair[l])));
            const hl_level info = level(hair[l], l);
            // Roots and wind of Walk are at most so fast.
            predicted[l] +=
                static_cast<double>(info.error_still + 0.75f * info.error_head + 2.6f * info.error_wind);
        }
    }
    for (std::uint32_t l = 1; l < HL_LEVEL_COUNT; ++l) {
        EXPECT_LE(measured[l], predicted[l]) << l;
        EXPECT_GE(measured[l], 0.1 * predicted[l]) << l;
        RecordProperty("level" + std::to_string(l), std::to_string(1e3 * measured[l] / 211) + " mm of " +
                                                        std::to_string(1e3 * predicted[l] / 211));
    }
}

TEST_F(RuntimeLevels, ACrowdKeepsTheErrorInPixels) {
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

TEST_F(RuntimeLevels, ABudgetIsKeptAndSpreadByPredictedError) {
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

TEST_F(RuntimeLevels, TheSameFramesComeToTheSameBits) {
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

TEST_F(RuntimeLevels, WhatSleepsOrIsNotSeenCostsNothing) {
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

TEST_F(RuntimeLevels, SleepingHairTakesAHundredthOfHairThatMoves) {
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
    EXPECT_LT(resting, 0.05) << "ms of fifty, planned and stepped";
}

TEST_F(RuntimeLevels, EffectsSayWhatTheyTookAndWhy) {
    Instance hair = another();
    hl_effect effect{};
    std::map<std::string, hl_effect> effects;
    static std::uint64_t now = 0;
    const auto clock = [](void*) { return now += 1000; };
    ASSERT_EQ(hl_instance_time(hair.get(), clock, nullptr, nullptr), HL_OK);
    ASSERT_TRUE(hair.step(Walk(3).frame));
    const std::uint64_t timed = hair.hash();
    for (std::uint32_t e = 0; e < HL_EFFECT_COUNT; ++e) {
        ASSERT_EQ(hl_instance_effect(hair.get(), e, &effect, nullptr), HL_OK);
        EXPECT_THAT(effect.why, testing::StartsWith(effect.name));
        effects[effect.name] = effect;
    }
    EXPECT_EQ(effects.size(), std::size_t{HL_EFFECT_COUNT});
    EXPECT_GT(effects["strands"].milliseconds, 0);
    EXPECT_EQ(effects["collision"].on, 1u);
    EXPECT_EQ(hl_instance_effect(hair.get(), HL_EFFECT_COUNT, &effect, nullptr), HL_BAD_VALUE);
    Instance untimed = another();
    ASSERT_TRUE(untimed.step(Walk(3).frame));
    EXPECT_EQ(untimed.hash(), timed) << "a clock changes no bits";
    ASSERT_TRUE(untimed.setLevel(HL_LEVEL_RIGID));
    ASSERT_TRUE(untimed.step(Walk(4).frame));
    EXPECT_EQ(untimed.describeEffect(0).on, 0u);
    EXPECT_THAT(untimed.describeEffect(0).why, HasSubstr("rigid"));
}

TEST_F(RuntimeLevels, FewerHairsAreTheFirstOfEachGuideAndWider) {
    Instance hair;
    ASSERT_TRUE(hair.make(asset_, HL_HAIRS | HL_LEVELS));
    ASSERT_TRUE(hair.step(Walk(5).frame));
    const hl_instance_info all = hair.describe();
    std::vector<float> every, some, radii;
    ASSERT_TRUE(hair.readHairs(every));
    ASSERT_EQ(hl_instance_set_level(hair.get(), HL_LEVEL_FINEST, 0.24f, nullptr), HL_OK);
    const hl_instance_info fewer = hair.describe();
    EXPECT_EQ(fewer.hairs, all.guides * 5) << "of 20 of each";
    ASSERT_TRUE(hair.readHairs(some));
    const std::size_t floats = 3 * std::size_t{all.points_per_hair};
    for (std::size_t h = 0; h < fewer.hairs; ++h) {
        const std::size_t from = h / 5 * 20 + h % 5;
        for (std::size_t i = 0; i < floats; ++i) ASSERT_EQ(some[h * floats + i], every[from * floats + i]);
    }
    radii.resize(std::size_t{fewer.hairs} * fewer.points_per_hair);
    ASSERT_EQ(hl_instance_read_hairs(hair.get(), kNothing, kNothing, game::tight(radii, 1), nullptr), HL_OK);
    EXPECT_FLOAT_EQ(radii[0], 4 * HairMaterial().rootRadius);
    for (const float share : {1e-6f, 1.0f}) {
        ASSERT_EQ(hl_instance_set_level(hair.get(), HL_LEVEL_RIGID, share, nullptr), HL_OK);
        EXPECT_EQ(hair.describe().hairs, share < 1 ? all.guides : all.hairs);
    }
    ASSERT_TRUE(hair.readHairs(every));
    EXPECT_TRUE(std::ranges::all_of(every, [](float v) { return std::isfinite(v); }));
}

TEST_F(RuntimeLevels, PlansLevelsAndStepsTakeNoMemory) {
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

TEST_F(RuntimeLevels, MemoryIsStatedBefore) {
    std::size_t levels = 0;
    ASSERT_EQ(hl_asset_levels_memory(asset_.get(), &levels, nullptr), HL_OK);
    Instance hair = another();
    for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
        hl_instance_set_level(hair.get(), l, 1, nullptr);
        for (int f = 1; f <= 5; ++f) ASSERT_TRUE(hair.step(Walk(f).frame));
    }
    const std::size_t stated = asset_.describe().guides_memory + levels;
    EXPECT_LE(hair.describe().bytes, stated);
    EXPECT_GE(hair.describe().bytes, stated / 4);
}

TEST_F(RuntimeLevels, WrongWordsAreRefusedAndChangeNothing) {
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

TEST_F(RuntimeLevels, AnyInputIsSurvivedAtAnyLevel) {
    std::vector<float> none(std::size_t{7} * first_.describe().guides, kNaN);
    for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
        Instance hair = another();
        const auto sound = [&](const char* what) {
            for (const Vec3f& point : guides(hair)) ASSERT_TRUE(point.allFinite()) << what << ", level " << l;
        };
        ASSERT_TRUE(hair.step(Walk(3).frame));
        hl_instance_set_level(hair.get(), l, 1, nullptr);
        Frame frame;
        frame.head = none.data();
        ASSERT_TRUE(hair.step(frame));
        sound("head");
        ASSERT_TRUE(hair.reset(frame));
        sound("reset");
        // Finite, and yet nowhere: squares of it are not.
        const std::array<float, 12> away{1, 0, 0, 1e30f, 0, 1, 0, 0, 0, 0, 1, 0};
        frame.head = away.data();
        ASSERT_TRUE(hair.step(frame));
        sound("a head beyond all numbers");
        frame = Frame();
        frame.roots = none.data();
        frame.root_count = hair.describe().guides;
        frame.wind = none.data();
        frame.origin[2] = static_cast<double>(kNaN);
        ASSERT_TRUE(hair.step(frame));
        sound("roots, wind, origin");
        for (const float dt : {1e-6f, 3.0f, 1e30f, 1 / 60.0f}) {
            ASSERT_TRUE(hair.step(Frame(dt)));
            sound("dt");
        }
        hl_instance_set_level(hair.get(), (l + 1) % HL_LEVEL_COUNT, 1, nullptr);
        sound("another level");
        hl_viewed viewed{hair.get(), 1e30f, 0, 0, 0};
        hl_crowd_limits limits;
        hl_crowd_limits_init(&limits);
        EXPECT_EQ(hl_crowd_plan(&limits, &viewed, 1, nullptr, nullptr), HL_OK);
        ASSERT_TRUE(hair.step(Walk(4).frame));
        sound("planned");
    }
}

TEST_F(RuntimeLevels, OneStrandHasLevels) {
    for (const auto& counts : {std::vector<std::uint32_t>{2}, {3}, {512}, {2, 9}}) {
        const std::vector<std::byte> bytes = written(helices(counts));
        Asset asset;
        ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
        Instance hair;
        Error error;
        ASSERT_TRUE(hair.make(asset, HL_GUIDES | HL_LEVELS, nullptr, &error)) << error.what();
        for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
            ASSERT_EQ(hl_instance_set_level(hair.get(), l, 1, nullptr), HL_OK);
            for (int f = 1; f < 4; ++f) ASSERT_TRUE(hair.step(Walk(f).frame));
            for (const Vec3f& point : guides(hair)) ASSERT_TRUE(point.allFinite());
        }
    }
}

}  // namespace
}  // namespace hairloom::test
