// SPDX-License-Identifier: GPL-3.0-or-later
// What later work adds to projective equations: hair keeps apart from hair, and takes on a style.
#include <gmock/gmock.h>

#include <random>

#include "hairloom/alternatives/projective_equations.h"
#include "tests/runtime/segment_methods.h"
#include "tests/runtime/threads.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr float kReach = 0.01f;

SimulationSettings meeting(SimulationSettings settings, float strength = 1.0f) {
    settings.hairHair = true;
    settings.hairHairStrength = strength;
    settings.hairHairCell = kReach;
    return settings;
}

/// Two hanging sticks of 10 cm, 3 cm apart as authored, whose roots are then brought to 1 mm of each other.
float distanceOfTips(const SimulationSettings& settings) {
    Strands strands;
    strands.add({-0.015f, 0.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.1f, 2);
    strands.add({0.015f, 0.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.1f, 2);
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, settings);
    std::vector<RootFrame> roots = strands.roots();
    for (int f = 1; f <= 200; ++f) {
        const float x = std::max(0.015f - 0.0002f * static_cast<float>(f), 0.0005f);
        roots[0].position.x = -x;
        roots[1].position.x = x;
        sticks.step({1.0f / 60.0f, f / 60.0, roots, {}});
    }
    const std::vector<Float3> now = positionsOf(sticks);
    EXPECT_NEAR(length(now[1] - now[0]), 0.1f, 1e-6f);
    EXPECT_NEAR(length(now[3] - now[2]), 0.1f, 1e-6f);
    return length(now[1] - now[3]);
}

TEST(ProjectiveHair, TipsKeepTheirReachFromOtherSticks) {
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.dampingTime = 0.05f;
    EXPECT_LT(distanceOfTips(s), 0.002f) << "without it they hang side by side";
    // Tips at the reach of each other: the other stick's nearest place is its tip or just before it.
    EXPECT_NEAR(distanceOfTips(meeting(s)), kReach, 0.05f * kReach);
    const float weak = distanceOfTips(meeting(s, 0.05f));
    EXPECT_LT(weak, 0.95f * kReach);
    EXPECT_GT(weak, 0.004f);
    EXPECT_LT(distanceOfTips(meeting(s, 0.0f)), 0.002f);
}

/// Strands that stand nearer to each other than the reach as authored feel nothing there.
TEST(ProjectiveHair, AnAuthoredStyleIsLeftAlone) {
    Strands strands;
    for (int i = 0; i < 30; ++i)
        strands.add({0.001f * static_cast<float>(i), 0.0f, 0.0005f * static_cast<float>(i % 3)},
                    {0.0f, -1.0f, 0.0f}, 0.01f, 8);
    SimulationSettings s = springSettings();
    ProjectiveEquations with = makeMethod<ProjectiveEquations>(strands, meeting(s));
    ProjectiveEquations without = makeMethod<ProjectiveEquations>(strands, s);
    run(with, strands, 60);
    run(without, strands, 60);
    const std::vector<Float3> a = positionsOf(with), b = positionsOf(without);
    for (std::size_t p = 0; p < a.size(); ++p) EXPECT_LT(length(a[p] - b[p]), 1e-5f) << p;
}

/// Hair that a turn of the head blows into other hair: how near its tips come to other strands, by looking at
/// all of them.
double deepest(const Strands& strands, const std::vector<Float3>& now) {
    double most = 0.0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            for (std::uint32_t q = 1; q < now.size(); ++q) {
                if (q >= strands.offsets[s] && q < strands.offsets[s + 1]) continue;
                if (std::ranges::find(strands.offsets, q) != strands.offsets.end()) continue;
                const auto apart = [&](const std::vector<Float3>& of) {
                    const Float3 along = of[q] - of[q - 1], from = of[p] - of[q - 1];
                    const double share = std::clamp(
                        static_cast<double>(dot(from, along)) / static_cast<double>(dot(along, along)), 0.0,
                        1.0);
                    return static_cast<double>(length(from - along * static_cast<float>(share)));
                };
                const double reach = std::min(static_cast<double>(kReach), apart(strands.points));
                most = std::max(most, 1.0 - apart(now) / reach);
            }
        }
    }
    return most;
}

TEST(ProjectiveHair, BlownHairStaysOutOfOtherHair) {
    Strands strands;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    for (int i = 0; i < 12; ++i) {
        Float3 out{uniform(random), -1.0f + 0.3f * uniform(random), uniform(random)};
        out = out * (1.0f / length(out));
        strands.add({0.02f * static_cast<float>(i % 4), 0.0f, 0.02f * static_cast<float>(i / 4)}, out, 0.02f,
                    5);
    }
    SimulationSettings s = bare();
    s.gravity = {3.0f, -9.81f, 0.0f};
    s.dampingTime = 0.1f;
    s.substeps = 8;
    const auto settled = [&](const SimulationSettings& settings) {
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, settings);
        double most = 0.0;
        for (int f = 0; f < 120; ++f) {
            run(sticks, strands, 1);
            EXPECT_LT(worstStretch(strands, positionsOf(sticks)), 2e-5);
            if (f >= 60) most = std::max(most, deepest(strands, positionsOf(sticks)));
        }
        return most;
    };
    const double open = settled(s), met = settled(meeting(s));
    RecordProperty("open", std::to_string(open));
    RecordProperty("met", std::to_string(met));
    EXPECT_GT(open, 0.6) << "share of its reach that a tip is too near";
    EXPECT_LT(met, 0.35);
}

TEST(ProjectiveHair, SameBitsForAnyNumberOfThreads) {
    const Strands strands = tuft(60, true);
    SimulationSettings s = meeting(springSettings());
    s.angularStiffness = 0.05f;
    s.windSpeed = 8.0f;
    std::vector<Float3> first;
    for (const Host& host : {Host{}, hostWithThreads(1), hostWithThreads(5), hostWithThreads(3, true)}) {
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s, host);
        for (int f = 1; f <= 30; ++f)
            sticks.step({1.0f / 60.0f,
                         f / 60.0,
                         strands.roots({}, turnAbout({0, 1, 0}, 0.1f * static_cast<float>(f))),
                         {}});
        const std::vector<Float3> now = positionsOf(sticks);
        if (first.empty()) first = now;
        EXPECT_EQ(now, first);
    }
}

/// All sticks within reach, by looking at each of them.
TEST(ProjectiveHair, NearSticksAreThoseOfALookAtAll) {
    Strands strands;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    for (int i = 0; i < 40; ++i) {
        Float3 out{uniform(random), uniform(random), uniform(random)};
        out = out * (1.0f / length(out));
        strands.add({0.03f * uniform(random), 0.03f * uniform(random), 0.03f * uniform(random)}, out, 0.01f,
                    4);
    }
    std::vector<Float3> now = strands.points;
    for (Float3& p : now) p = p + Float3{uniform(random), uniform(random), uniform(random)} * 0.002f;
    const std::vector<Float3> velocities(now.size(), {0.5f, 0.0f, 0.0f});
    NearSticks near;
    near.make(strands.view(), 0.004f);
    near.find(now, velocities, {});
    std::size_t found = 0, full = 0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            std::vector<std::pair<float, std::uint32_t>> all;
            for (std::uint32_t t = 0; t < strands.count(); ++t) {
                for (std::uint32_t q = strands.offsets[t] + 1; t != s && q < strands.offsets[t + 1]; ++q) {
                    const float apart = length(nearestOnStick(now[q - 1], now[q], now[p]) - now[p]);
                    if (apart <= 0.008f) all.emplace_back(apart, q);
                }
            }
            std::ranges::sort(all);
            if (all.size() > NearSticks::kMost) ++full;
            all.resize(std::min(all.size(), NearSticks::kMost));
            ASSERT_EQ(near.of(p).size(), all.size()) << p;
            for (std::size_t i = 0; i < all.size(); ++i) {
                const NearSticks::Near& one = near.of(p)[i];
                EXPECT_EQ(one.stick, all[i].second) << p;
                EXPECT_LE(one.reach, 0.004f);
                const Float3 later = near.nearest(one.stick, now[p] + Float3{0.05f, 0.0f, 0.0f}, 0.1f);
                EXPECT_NEAR(length(later - now[p] - Float3{0.05f, 0.0f, 0.0f}), all[i].first, 1e-6f);
                ++found;
            }
        }
    }
    EXPECT_GT(found, 200u);
    EXPECT_GT(full, 3u) << "more than are kept";
}

/// Each strand of another curve than authored, with segments as long.
std::vector<Float3> styled(const Strands& strands) {
    std::vector<Float3> style = strands.points;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        const float turn = 0.15f + 0.05f * static_cast<float>(s % 5);
        for (std::uint32_t p = strands.offsets[s] + 2; p < strands.offsets[s + 1]; ++p) {
            const float along = static_cast<float>(p - strands.offsets[s]);
            const Quat bend =
                turnAbout({0.6f, 0.0f, 0.8f}, turn * along) * turnAbout({0.0f, 1.0f, 0.0f}, 0.1f * along);
            style[p] = style[p - 1] + rotate(bend, strands.points[p] - strands.points[p - 1]);
        }
    }
    return style;
}

float farthestOf(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    float most = 0.0f;
    for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, length(a[p] - b[p]));
    return most;
}

TEST(ProjectiveHair, EachStrandTurnsToItsStyleAndBack) {
    const Strands strands = tuft(6, true);
    SimulationSettings s = springSettings();
    s.airDrag = 0.0f;
    s.dampingTime = 0.1f;
    // Without weight, and where the style carries it.
    for (const float carried : {0.0f, 1.0f}) {
        s.gravity = carried > 0.0f ? Float3{0.0f, -2.0f, 0.0f} : Float3{};
        s.restGravity = carried;
        s.angularStiffness = 0.6f;
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
        run(sticks, strands, 10);
        const std::vector<Float3> before = positionsOf(sticks), style = styled(strands);
        ASSERT_GT(farthestOf(before, style), 0.02f);
        ASSERT_EQ(sticks.setStyle(style), "");
        EXPECT_EQ(positionsOf(sticks), before) << "nothing jumps";
        run(sticks, strands, 1);
        EXPECT_LT(worstStretch(strands, positionsOf(sticks)), 2e-5);
        run(sticks, strands, 400);
        EXPECT_LT(farthestOf(positionsOf(sticks), style), 2e-4f) << carried;
        ASSERT_EQ(sticks.setStyle({}), "");
        run(sticks, strands, 400);
        EXPECT_LT(farthestOf(positionsOf(sticks), strands.points), 2e-4f) << carried;
    }
}

TEST(ProjectiveHair, AStyleOfOtherStrandsIsRefused) {
    const Strands strands = tuft(3);
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, springSettings());
    using testing::HasSubstr;
    std::vector<Float3> style = strands.points;
    EXPECT_EQ(sticks.setStyle(style), "");
    style.pop_back();
    EXPECT_THAT(sticks.setStyle(style), HasSubstr("35 points; expected 36"));
    style = strands.points;
    style[5].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(sticks.setStyle(style), HasSubstr("point 5"));
    style = strands.points;
    style[12].x += 0.001f;
    EXPECT_THAT(sticks.setStyle(style), HasSubstr("strand 1 of the style grows elsewhere"));
    style = strands.points;
    style[30] = style[29] + (style[30] - style[29]) * 1.2f;
    EXPECT_THAT(sticks.setStyle(style), HasSubstr("segment 6 of strand 2"));
}

}  // namespace
}  // namespace hairloom::runtime
