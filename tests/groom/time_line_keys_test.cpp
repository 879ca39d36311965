// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/time_line_keys.h"

#include <gtest/gtest.h>

#include <random>

namespace hairloom {
namespace {

using Of = KeyTrack::Of;

const KeyTrack kWind{Of::wind, {}}, kHead{Of::head, {}}, kClips{Of::clips, {}},
    kSpeed{Of::setting, "simulation.windSpeed"}, kKind{Of::setting, "simulation.windKind"};

TimeLine line() {
    TimeLine line;
    line.framesPerSecond = 30;
    for (const float time : {0.0f, 1.0f, 2.0f}) keySetting(line, kSpeed.name, time, {2 * time, 0, 0});
    return line;
}

TEST(TimeLineKeys, AKeyWithinHalfAFrameIsReplacedAndKeepsItsInterpolation) {
    TimeLine edited = line();
    setInterpolation(edited, std::vector<KeyPlace>{{kSpeed, 1}}, KeyInterpolation::smooth);
    keySetting(edited, kSpeed.name, 1.01f, {9, 0, 0});
    ASSERT_EQ(edited.settings[0].keys.size(), 3u);
    EXPECT_EQ(edited.settings[0].keys[1].value.x(), 9);
    EXPECT_EQ(edited.settings[0].keys[1].interpolation, KeyInterpolation::smooth);
    keySetting(edited, kSpeed.name, 1.5f, {7, 0, 0});
    ASSERT_EQ(edited.settings[0].keys.size(), 4u);
    EXPECT_EQ(edited.settings[0].keys[2].interpolation, KeyInterpolation::smooth) << "as the one before";
}

TEST(TimeLineKeys, KeysMoveByFramesAndTakeThePlaceOfOthers) {
    TimeLine edited = line();
    const std::vector<KeyPlace> first{{kSpeed, 0}};
    EXPECT_EQ(moveKeys(edited, first, -5), first) << "none goes before time 0";
    EXPECT_EQ(edited, line());
    EXPECT_EQ(moveKeys(edited, first, 45), (std::vector<KeyPlace>{{kSpeed, 1}}));
    EXPECT_EQ(keyTimes(edited, kSpeed), (std::vector<float>{1, 1.5f, 2}));
    EXPECT_EQ(edited.settings[0].keys[1].value.x(), 0);
    edited = line();
    moveKeys(edited, first, 30);
    EXPECT_EQ(keyTimes(edited, kSpeed), (std::vector<float>{1, 2}));
    EXPECT_EQ(edited.settings[0].keys[0].value.x(), 0) << "the one that was moved stays";
}

TEST(TimeLineKeys, CopiesKeepTheirDistancesAcrossTracks) {
    TimeLine edited = line();
    keyWind(edited, 1.5f, {1, 2, 3});
    const auto copies = copyKeys(edited, std::vector<KeyPlace>{{kSpeed, 1}, {kWind, 0}}, 3);
    EXPECT_EQ(keyTimes(edited, kSpeed), (std::vector<float>{0, 1, 2, 3}));
    EXPECT_EQ(keyTimes(edited, kWind), (std::vector<float>{1.5f, 3.5f}));
    EXPECT_EQ(copies.size(), 2u);
    removeKeys(edited, copies);
    EXPECT_EQ(keyTimes(edited, kSpeed), (std::vector<float>{0, 1, 2}));
    removeKeys(edited, std::vector<KeyPlace>{{kSpeed, 0}, {kSpeed, 1}, {kSpeed, 2}, {kWind, 0}});
    EXPECT_TRUE(edited.isEmpty()) << "a track without keys is none";
}

TEST(TimeLineKeys, WhatHasNothingBetweenItsValuesLeavesBySteps) {
    TimeLine edited;
    keySetting(edited, kKind.name, 0.5f, {1, 0, 0});
    const std::vector<KeyPlace> key{{kKind, 0}};
    EXPECT_EQ(interpolationOf(edited, key[0]), KeyInterpolation::step);
    setInterpolation(edited, key, KeyInterpolation::smooth);
    EXPECT_EQ(interpolationOf(edited, key[0]), KeyInterpolation::step);
    ASSERT_EQ(numbersOf(kKind).size(), 1u);
    EXPECT_FALSE(numbersOf(kKind)[0].choices.empty());
}

TEST(TimeLineKeys, ClipsStayApartAndBlendNoLongerThanTheyPlay) {
    TimeLine edited;
    edited.framesPerSecond = 10;
    addClip(edited, {"walk", 0});
    addClip(edited, {"run", 2});
    edited.clips[1].blend = 1;
    addClip(edited, {"stop", 2.4f});
    EXPECT_NEAR(edited.clips[1].blend, 0.4, 1e-6);
    moveKeys(edited, std::vector<KeyPlace>{{kClips, 1}}, -20);
    EXPECT_EQ(edited.clips[0].name, "run") << "the one that was moved is where it was moved to";
    EXPECT_NEAR(edited.clips[1].start, 0.1, 1e-6);
    EXPECT_EQ(edited.clips[0].blend, 0);
    EXPECT_TRUE(problemsOf(edited).empty());
}

TEST(TimeLineKeys, NumbersOfEachTrackAreReadAndSet) {
    TimeLine edited = line();
    keyHead(edited, {});
    keyWind(edited, 0, Vec3f::Zero());
    for (const KeyTrack& track : tracksOf(edited)) {
        const auto numbers = numbersOf(track);
        ASSERT_FALSE(numbers.empty());
        for (std::size_t n = 0; n < numbers.size(); ++n) {
            setNumber(edited, {track, 0}, n, 0.25);
            EXPECT_EQ(numberOf(edited, {track, 0}, n), 0.25);
        }
    }
    EXPECT_TRUE(problemsOf(edited).empty());
}

/// Whatever a person does, it can be saved.
TEST(TimeLineKeys, RandomEditsLeaveASoundTimeLine) {
    std::mt19937 random(7);
    const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
    TimeLine edited;
    for (int round = 0; round < 4000; ++round) {
        const float time = static_cast<float>(below(120)) / 24;
        std::vector<KeyPlace> keys;
        for (const KeyTrack& track : tracksOf(edited)) {
            for (std::size_t k = 0; k < keyTimes(edited, track).size(); ++k) {
                if (below(4) == 0) keys.push_back({track, k});
            }
        }
        std::vector<KeyPlace> after;
        switch (below(9)) {
            case 0:
                keyHead(edited, {time});
                break;
            case 1:
                keyWind(edited, time, {1, 0, 0});
                break;
            case 2:
                keySetting(edited, kSpeed.name, time, {3, 0, 0});
                break;
            case 3:
                keySetting(edited, kKind.name, time, {0, 0, 0});
                break;
            case 4:
                addClip(edited, {"clip", time});
                edited.clips.back().blend = edited.clips.size() > 1 ? 0.5f : 0;
                break;
            case 5:
                after = moveKeys(edited, keys, static_cast<std::int64_t>(below(41)) - 20);
                break;
            case 6:
                after = copyKeys(edited, keys, time);
                break;
            case 7:
                setInterpolation(edited, keys, static_cast<KeyInterpolation>(below(3)));
                break;
            default:
                removeKeys(edited, keys);
        }
        const auto problems = problemsOf(edited);
        ASSERT_TRUE(problems.empty()) << round << ": " << problems[0].where << " " << problems[0].what;
        for (const KeyPlace& key : after) ASSERT_LT(key.index, keyTimes(edited, key.track).size());
    }
}

}  // namespace
}  // namespace hairloom
