// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail: what is predicted holds, and what is set reaches all of them.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

#include "exporters/seen_motion.h"
#include "hairloom/effects.h"
#include "tests/exporters/levels_sample.h"

namespace hairloom::test {
namespace {

using game::Asset;
using game::Error;
using game::Frame;
using game::Instance;
using game::kNothing;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

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

TEST_F(RuntimeLevels, WhatIsSeenFarOffIsAsFarOffAsPredictedAndLessThanPathsAre) {
    std::vector<std::uint32_t> offsets(first_.describe().guides + 1);
    ASSERT_EQ(hl_instance_offsets(first_.get(), offsets.data(), offsets.size(), nullptr), HL_OK);
    const std::vector<std::uint32_t> layers(offsets.size() - 1);
    const std::vector<Vec3f> rest = guides(first_);
    std::vector<SeenMotion> seen(HL_LEVEL_COUNT, SeenMotion(offsets, rest, layers));
    for (std::uint32_t l = 0; l < HL_LEVEL_COUNT; ++l) {
        Instance hair = another();
        ASSERT_EQ(hl_instance_set_level(hair.get(), l, 1, nullptr), HL_OK);
        for (int f = 1; f <= 330; ++f) {
            ASSERT_TRUE(hair.step(Walk(f).frame));
            if (f > 30) seen[l].add(guides(hair));
        }
    }
    float paths = 0, farOff = 0;
    for (std::uint32_t l = 1; l < HL_LEVEL_COUNT; ++l) {
        const hl_level now = level(first_, l), before = level(first_, l - 1);
        EXPECT_GE(now.seen_head, before.seen_head) << l;
        EXPECT_GE(now.seen_wind, before.seen_wind) << l;
        const float predicted = now.seen_still + 0.75f * now.seen_head + 2.6f * now.seen_wind;
        const float measured = SeenMotion::between(seen[0], seen[l]).largest();
        EXPECT_LE(measured, predicted) << l;
        EXPECT_GT(measured, 0) << l;
        RecordProperty("level" + std::to_string(l),
                       std::to_string(1e3f * measured) + " mm of " + std::to_string(1e3f * predicted));
        if (l == HL_LEVEL_RIGID) continue;
        paths += now.error_still + now.error_wind * 3;
        farOff += now.seen_still + now.seen_wind * 3;
    }
    EXPECT_LT(farOff, 0.8f * paths);
    EXPECT_GT(level(first_, HL_LEVEL_RIGID).seen_wind, 2 * level(first_, HL_LEVEL_RIGID - 1).seen_wind)
        << "hair that stands still in wind is seen";
}

TEST_F(RuntimeLevels, ACrowdIsPlannedByWhatIsSeenUnlessPathsAreAskedFor) {
    Instance hair = another();
    for (int f = 1; f <= 30; ++f) ASSERT_TRUE(hair.step(Walk(f).frame));
    hl_crowd_limits limits;
    hl_crowd_limits_init(&limits);
    EXPECT_EQ(limits.strict, 0u);
    std::array<std::uint32_t, 2> sums{};
    for (const std::uint32_t strict : {0u, 1u}) {
        limits.strict = strict;
        for (float pixels = 20; pixels < 2000; pixels *= 1.2f) {
            ASSERT_EQ(hl_instance_set_level(hair.get(), 0, 1, nullptr), HL_OK);
            hl_viewed viewed{hair.get(), pixels, 0, 0, 0};
            ASSERT_EQ(hl_crowd_plan(&limits, &viewed, 1, nullptr, nullptr), HL_OK);
            sums[strict] += viewed.level;
        }
    }
    EXPECT_GT(sums[0], sums[1] + 4) << "coarser levels nearer by";
    // A caller of before, whose struct ends before `strict`.
    limits.size = offsetof(hl_crowd_limits, strict);
    hl_viewed viewed{hair.get(), 100, 0, 0, 0};
    EXPECT_EQ(hl_crowd_plan(&limits, &viewed, 1, nullptr, nullptr), HL_OK);
}

TEST_F(RuntimeLevels, SettingsOfAGameReachEachOne) {
    const std::pair<const char*, double> kSet[] = {
        {"substeps", 6}, {"windSpeed", 4}, {"airDrag", 8}, {"strandModel", 1}};
    for (const auto& [name, value] : kSet) {
        // As if it had been exported so.
        Groom groom = hair();
        ASSERT_TRUE(
            setFieldValue(groom.simulation, *runtime::findField<runtime::SimulationSettings>(name), value));
        const auto bytes = written(groom);
        Asset asset;
        Instance exported;
        ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
        ASSERT_TRUE(exported.make(asset, HL_GUIDES | HL_LEVELS));
        for (std::uint32_t l = 0; l < HL_LEVEL_RIGID; ++l) {
            Instance before = another(), after = another(), unset = another(), same;
            ASSERT_TRUE(same.copy(exported));
            ASSERT_TRUE(before.set(name, value));
            for (Instance* const hair : {&before, &after, &unset, &same}) ASSERT_TRUE(hair->setLevel(l));
            ASSERT_TRUE(after.set(name, value));
            EXPECT_EQ(level(after, l).substeps, level(exported, l).substeps) << name << ", level " << l;
            for (int f = 1; f <= 10; ++f) {
                Walk walk(f);
                walk.frame.wind = nullptr;
                for (Instance* const hair : {&before, &after, &unset, &same})
                    ASSERT_TRUE(hair->step(walk.frame));
            }
            const auto apart = [&](const Instance& hair) {
                return rootMeanSquare(guides(hair), guides(same));
            };
            EXPECT_LT(apart(before), 1e-6f) << name << ", level " << l;
            EXPECT_LT(apart(after), 1e-6f) << name << ", level " << l;
            const bool left = std::string_view(name) == "substeps" && l + 1 == HL_LEVEL_RIGID;
            EXPECT_EQ(apart(unset) < 1e-6f, left) << name << ", level " << l;
        }
    }
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
    for (std::uint32_t e = 0; hl_instance_effect(hair.get(), e, &effect, nullptr) == HL_OK; ++e) {
        EXPECT_THAT(effect.why, testing::StartsWith(effect.name));
        effects[effect.name] = effect;
    }
    const std::uint32_t all = runtime::kEffectCount + 1;  // and what every strand takes
    EXPECT_EQ(effects.size(), all);
    EXPECT_GT(effects["strands"].milliseconds, 0);
    EXPECT_EQ(effects["collision"].on, 1u);
    EXPECT_EQ(hl_instance_effect(hair.get(), all, &effect, nullptr), HL_BAD_VALUE);
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
