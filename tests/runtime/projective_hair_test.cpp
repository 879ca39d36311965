// SPDX-License-Identifier: GPL-3.0-or-later
// What later work adds to projective equations: hair keeps apart from hair, and takes on a style.
#include <gmock/gmock.h>

#include <array>
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
    // Their weight takes back in a frame what they are turned apart in it.
    EXPECT_NEAR(distanceOfTips(meeting(s)), kReach, 0.12f * kReach);
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

/// Mean over strands of the share of the reach by which the tip is too near to another strand, by looking at
/// all of them.
double crowding(const Strands& strands, const std::vector<Float3>& now) {
    double sum = 0.0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        const std::uint32_t tip = strands.offsets[s + 1] - 1;
        double nearest = static_cast<double>(kReach);
        for (std::uint32_t t = 0; t < strands.count(); ++t) {
            for (std::uint32_t q = strands.offsets[t] + 1; t != s && q < strands.offsets[t + 1]; ++q) {
                const Float3 along = now[q] - now[q - 1], from = now[tip] - now[q - 1];
                const float share = std::clamp(dot(from, along) / dot(along, along), 0.0f, 1.0f);
                nearest = std::min(nearest, static_cast<double>(length(from - along * share)));
            }
        }
        sum += 1.0 - nearest / static_cast<double>(kReach);
    }
    return sum / strands.count();
}

/// Twelve strands 2 cm apart hang side by side; then their roots are brought to 5 mm of each other, half of
/// the reach. Stiff hair splays.
TEST(ProjectiveHair, CrowdedHairSplays) {
    Strands strands;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    for (int i = 0; i < 12; ++i) {
        Float3 out{0.05f * uniform(random), -1.0f, 0.05f * uniform(random)};
        out = out * (1.0f / length(out));
        strands.add({0.02f * static_cast<float>(i % 4), 0.0f, 0.02f * static_cast<float>(i / 4)}, out, 0.02f,
                    5);
    }
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.angularStiffness = 0.3f;
    s.dampingTime = 0.1f;
    s.substeps = 8;
    const auto settled = [&](const SimulationSettings& settings) {
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, settings);
        std::vector<RootFrame> roots = strands.roots();
        double sum = 0.0;
        for (int f = 0; f < 150; ++f) {
            const float size = std::max(1.0f - 0.02f * static_cast<float>(f), 0.25f);
            for (std::uint32_t r = 0; r < strands.count(); ++r)
                roots[r].position = strands.points[strands.offsets[r]] * size;
            sticks.step({1.0f / 60.0f, f / 60.0, roots, {}});
            EXPECT_LT(worstStretch(strands, positionsOf(sticks)), 2e-5);
            if (f >= 90) sum += crowding(strands, positionsOf(sticks)) / 60.0;
        }
        return sum;
    };
    const double open = settled(s), half = settled(meeting(s, 0.5f)), met = settled(meeting(s));
    EXPECT_GT(open, 0.45);
    EXPECT_LT(half, 0.5 * open);
    EXPECT_LT(met, 0.5 * half);
    EXPECT_LT(met, 0.08);
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

/// What sticks ask of a tip, by looking at each of them in double precision.
TEST(ProjectiveHair, TipsAreAskedWhatALookAtAllSticksSays) {
    using Vec = std::array<double, 3>;
    const auto minus = [](const Vec& a, const Vec& b) { return Vec{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
    const auto plus = [](const Vec& a, const Vec& b, double t) {
        return Vec{a[0] + b[0] * t, a[1] + b[1] * t, a[2] + b[2] * t};
    };
    const auto inner = [](const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto wide = [](const std::vector<Float3>& of, std::size_t i) {
        return Vec{static_cast<double>(of[i].x), static_cast<double>(of[i].y), static_cast<double>(of[i].z)};
    };
    Strands strands;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto vector = [&](float size) {
        return Float3{uniform(random), uniform(random), uniform(random)} * size;
    };
    for (int i = 0; i < 100; ++i) {
        Float3 out = vector(1.0f);
        out = out * (1.0f / length(out));
        strands.add(vector(0.02f), out, 0.01f, 4);
    }
    std::vector<Float3> now = strands.points, velocities;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        const Float3 moved = vector(0.006f);
        for (std::uint32_t p = strands.offsets[s]; p < strands.offsets[s + 1]; ++p) now[p] = now[p] + moved;
    }
    for (std::size_t p = 0; p < now.size(); ++p) velocities.push_back(vector(1.0f));
    NearSticks near;
    near.make(strands.view(), 0.004f);
    near.find(now, velocities, {});
    std::size_t pushed = 0, braked = 0, alone = 0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            Vec push{}, brake{};
            double mostPush = 0, mostBrake = 0;
            for (std::uint32_t t = 0; t < strands.count(); ++t) {
                for (std::uint32_t q = strands.offsets[t] + 1; t != s && q < strands.offsets[t + 1]; ++q) {
                    double share = 0;
                    const auto apart = [&](const std::vector<Float3>& of) {
                        const Vec along = minus(wide(of, q), wide(of, q - 1)),
                                  from = minus(wide(of, p), wide(of, q - 1));
                        share = std::clamp(inner(from, along) / inner(along, along), 0.0, 1.0);
                        return plus(from, along, -share);
                    };
                    const Vec atRest = apart(strands.points), here = apart(now);
                    const double distance = std::sqrt(inner(here, here));
                    const double depth = std::min(0.004, std::sqrt(inner(atRest, atRest))) - distance;
                    if (!(depth > 0)) continue;
                    const Vec other = plus(wide(velocities, q - 1),
                                           minus(wide(velocities, q), wide(velocities, q - 1)), share);
                    const double closing = -inner(minus(wide(velocities, p), other), here) / distance;
                    push = plus(push, here, 0.5 * depth / distance);
                    brake = plus(brake, here, 0.5 * std::max(closing, 0.0) / distance);
                    mostPush = std::max(mostPush, 0.5 * depth);
                    mostBrake = std::max(mostBrake, 0.5 * closing);
                }
            }
            const auto limited = [&](const Vec& v, double most) {
                const double size = std::sqrt(inner(v, v));
                return plus(Vec{}, v, size > most ? most / size : 1.0);
            };
            push = limited(push, mostPush);
            brake = limited(brake, mostBrake);
            const NearSticks::Away& found = near.of(p);
            EXPECT_LT(length(found.push - Float3{static_cast<float>(push[0]), static_cast<float>(push[1]),
                                                 static_cast<float>(push[2])}),
                      2e-6f)
                << p;
            EXPECT_LT(length(found.brake - Float3{static_cast<float>(brake[0]), static_cast<float>(brake[1]),
                                                  static_cast<float>(brake[2])}),
                      2e-3f)
                << p;
            pushed += mostPush > 0 ? 1 : 0;
            braked += mostBrake > 0 ? 1 : 0;
            alone += mostPush > 0 ? 0 : 1;
        }
    }
    EXPECT_GT(pushed, 60u);
    EXPECT_GT(braked, 40u);
    EXPECT_GT(alone, 60u);
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
