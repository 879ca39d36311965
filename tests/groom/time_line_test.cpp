// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/time_line.h"

#include <gmock/gmock.h>

#include <limits>

#include "core/groom/file/time_line_json.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

TimeLine withSetting(const char* name, std::vector<SettingKey> keys) {
    TimeLine line;
    line.settings = {{name, std::move(keys)}};
    return line;
}

TEST(TimeLine, ValuesGoFromKeyToKeyByTheirInterpolation) {
    using enum KeyInterpolation;
    const TimeLine line = withSetting("simulation.windSpeed", {{1, Vec3d(2, 0, 0), linear},
                                                               {2, Vec3d(4, 0, 0), step},
                                                               {3, Vec3d(8, 0, 0), smooth},
                                                               {5, Vec3d(0, 0, 0), linear}});
    const auto speed = [&](float time) { return settingsAt(line, time, {}).windSpeed; };
    EXPECT_EQ(speed(0), 2) << "the first holds before";
    EXPECT_FLOAT_EQ(speed(1.25f), 2.5f);
    EXPECT_EQ(speed(2), 4);
    EXPECT_EQ(speed(2.999f), 4);
    EXPECT_EQ(speed(3), 8);
    EXPECT_FLOAT_EQ(speed(4), 4) << "half of the way at half of the time";
    EXPECT_NEAR(speed(3.02f), 8, 0.01) << "it leaves at rest";
    EXPECT_EQ(speed(99), 0) << "the last holds behind";
    runtime::SimulationSettings authored;
    authored.substeps = 3;
    EXPECT_EQ(settingsAt(line, 2, authored).substeps, 3u) << "what is not keyed stays";
}

TEST(TimeLine, ALoopBeginsAnewAtItsEnd) {
    TimeLine line;
    line.start = 1, line.end = 3;
    EXPECT_EQ(line.timeAt(0.5f), 1.5f);
    EXPECT_EQ(line.timeAt(2), 3) << "the last frame";
    EXPECT_EQ(line.timeAt(2.25f), 1.25f);
    EXPECT_EQ(line.timeAt(4), 3);
    EXPECT_EQ(line.timeAt(4.5f), 1.5f);
    line.loop = false;
    EXPECT_EQ(line.timeAt(4.5f), 5.5f);
    line.framesPerSecond = 24;
    EXPECT_EQ(line.frameCount(), 48u);
}

TEST(TimeLine, WhatChoosesTheEngineHasNoKeys) {
    for (const char* const name :
         {"strandModel", "hairHair", "hairHairCell", "windShelter", "collisionSegments", "latticeNodes"})
        EXPECT_EQ(findKeyable(std::string("simulation.") + name), nullptr) << name;
    EXPECT_NE(findKeyable("simulation.hairHairStrength"), nullptr);
    for (const char* const name :
         {"shadingModel", "tubes", "streakShare", "streakSeed", "greyShare", "dyeStrength", "windSpeed"})
        EXPECT_EQ(findKeyable(std::string("material.") + name), nullptr) << name;
    for (const char* const name : {"interpolation.blend", "rootColour", "material", "material."})
        EXPECT_EQ(findKeyable(name), nullptr) << name;
}

TEST(TimeLine, MaterialsGoFromKeyToKeyAndKeepWhatIsNotKeyed) {
    TimeLine line = withSetting("material.rootColour", {{1, Vec3d(0, 0.5, 1)}, {2, Vec3d(1, 0.5, 0)}});
    EXPECT_TRUE(keysMaterial(line));
    HairMaterial authored;
    authored.eumelanin = 5;
    EXPECT_EQ(materialAt(line, 0, authored).rootColour, Vec3f(0, 0.5f, 1));
    EXPECT_TRUE(materialAt(line, 1.25f, authored).rootColour.isApprox(Vec3f(0.25f, 0.5f, 0.75f)));
    EXPECT_EQ(materialAt(line, 9, authored).rootColour, Vec3f(1, 0.5f, 0));
    EXPECT_EQ(materialAt(line, 9, authored).tipColour, authored.tipColour);
    EXPECT_EQ(materialAt(line, 9, authored).eumelanin, 5);
    EXPECT_TRUE(settingsAt(line, 1.5f, {}) == runtime::SimulationSettings());
    line.settings[0].keys[1].value[2] = 1.5;
    ASSERT_EQ(problemsOf(line).size(), 1u);
    EXPECT_EQ(problemsOf(line)[0].where, "settings/0/keys/1/value");
    EXPECT_FALSE(keysMaterial(withSetting("simulation.windSpeed", {{0, Vec3d(1, 0, 0)}})));
}

TEST(TimeLine, EveryKeyableSettingCanBeKeyedAndRead) {
    EXPECT_THAT(keyableNames(), testing::Contains("simulation.windSpeed"));
    EXPECT_THAT(keyableNames(), testing::Contains("material.rootColour"));
    EXPECT_THAT(keyableNames(), testing::Not(testing::Contains("simulation.angularCurve")));
    Groom groom;
    for (const std::string& name : keyableNames()) {
        ASSERT_TRUE(findKeyable(name)) << name;
        const Vec3d value = authoredValue(groom, name);
        const TimeLine line = withSetting(
            name.c_str(), {{0.5f, value, KeyInterpolation::step}, {1, value, KeyInterpolation::step}});
        EXPECT_THAT(problemsOf(line), testing::IsEmpty()) << name;
        const auto read = parseTimeLine("x", timeLineText(line));
        ASSERT_TRUE(read) << name << read.error().message();
        EXPECT_EQ(*read, line) << name;
        EXPECT_TRUE(settingsAt(line, 0.7f, {}) == groom.simulation) << name;
        groom.material = materialAt(line, 0.7f, {});
        EXPECT_EQ(authoredValue(groom, name), value) << name;
    }
}

TEST(TimeLine, TextKeepsEveryBit) {
    const TimeLine line = timeLineOf(fullGroom());
    const auto read = parseTimeLine("x", timeLineText(line));
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(*read, line);
    const auto motion = parseMotion("x", motionText(line));
    ASSERT_TRUE(motion) << motion.error().message();
    EXPECT_EQ(motion->head, line.head);
    EXPECT_EQ(motion->wind, line.wind);
}

TEST(TimeLine, NumbersThatAreNoneAreFound) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const auto first = [](const TimeLine& line) {
        const auto problems = problemsOf(line);
        return problems.empty() ? std::string() : problems[0].where + " " + problems[0].what;
    };
    TimeLine line;
    EXPECT_EQ(first(line), "");
    line.framesPerSecond = kNaN;
    EXPECT_THAT(first(line), HasSubstr("framesPerSecond is nan"));
    line = {};
    line.end = kNaN;
    EXPECT_THAT(first(line), HasSubstr("end is nan"));
    line = {};
    line.head = {{kNaN}};
    EXPECT_THAT(first(line), HasSubstr("head/0/t is nan"));
    line.head = {{0, Vec3d(0, std::numeric_limits<double>::quiet_NaN(), 0)}};
    EXPECT_THAT(first(line), HasSubstr("head/0/translate"));
    line.head = {{0, Vec3d::Zero(), Vec3f(0, kNaN, 0)}};
    EXPECT_THAT(first(line), HasSubstr("head/0/axis"));
    line.head = {{0, Vec3d::Zero(), Vec3f(0, 1e-22f, 0)}};
    EXPECT_THAT(first(line), HasSubstr("head/0/axis")) << "too short to have a direction in single precision";
    line.head = {{0, Vec3d::Zero(), Vec3f::UnitX(), kNaN}};
    EXPECT_THAT(first(line), HasSubstr("head/0/degrees"));
    line = {};
    line.wind = {{0, Vec3f(kNaN, 0, 0)}};
    EXPECT_THAT(first(line), HasSubstr("wind/0/velocity"));
    line = withSetting("simulation.windSpeed", {{0, Vec3d::Constant(static_cast<double>(kNaN))}});
    EXPECT_THAT(first(line), HasSubstr("settings/0/keys/0/value is nan"));
    line = withSetting("simulation.windSpeed", {{0, Vec3d::Zero()}, {0, Vec3d::Zero()}});
    EXPECT_THAT(first(line), HasSubstr("settings/0/keys/1/t is 0 s, not later"));
    line = withSetting("simulation.windSpeed", {{0, Vec3d::Zero()}});
    line.settings.push_back(line.settings[0]);
    EXPECT_THAT(first(line), HasSubstr("settings/1/name is \"simulation.windSpeed\" again"));
    line = {};
    line.clips = {{"a", 0, 0, 0, kNaN}};
    EXPECT_THAT(first(line), HasSubstr("clips/0/speed is nan"));
    line.clips = {{"a", 0}, {"b", 1, 0, 0, 1, true, 1}, {"c", 1.5f}};
    EXPECT_THAT(first(line), HasSubstr("clips/1/blend is 1 s"));
}

}  // namespace
}  // namespace hairloom
