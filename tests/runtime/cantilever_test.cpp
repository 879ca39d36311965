// SPDX-License-Identifier: GPL-3.0-or-later
// Hair held horizontally that bends under its own weight, against the heavy elastica.
#include <algorithm>
#include <cstdio>

#include "tests/runtime/strand_fixture.h"
#include "tests/simulation/elastica.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr float kLength = 0.1f;  // metres that are free to bend
constexpr double kGravity = 9.81;

/// The setting that stands for a bending stiffness of B m⁴/s².
float settingOf(double B) {
    return static_cast<float>(B / (B + kHairBendingStiffness));
}

/// All by default but that the strand's shape carries no gravity, is equally stiff everywhere and may not
/// fall asleep on its way down.
SimulationSettings cantilever(double B) {
    SimulationSettings s = springSettings();
    s.angularStiffness = settingOf(B);
    s.angularCurve = {};
    s.restGravity = 0.0f;
    s.sleepSpeed = 0.0f;
    s.gravity = {0.0f, -static_cast<float>(kGravity), 0.0f};
    return s;
}

/// The tip at rest, from the point where the clamp ends, of a strand whose first segment is clamped and whose
/// other `segments` have the length kLength together. The clamp of a rod ends where its bending begins, at
/// the second point.
Float3 tipAtRest(const SimulationSettings& settings, std::uint32_t segments) {
    const float segment = kLength / static_cast<float>(segments);
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, segment, segments + 2);
    Engine engine = makeEngine(strands, settings);
    Float3 tip = positionsOf(engine).back(), before{};
    for (int second = 0; second < 40 && length(tip - before) > 1e-5f; ++second) {
        before = tip;
        run(engine, strands, 60);
        tip = positionsOf(engine).back();
    }
    EXPECT_LT(length(tip - before), 2e-5f) << "not yet at rest";
    return tip - Float3{segment, 0.0f, 0.0f};
}

/// Distance of the tip from the elastica's, as a share of the length.
double tipError(Float3 tip, const test::ElasticaShape& exact) {
    const double x = static_cast<double>(tip.x) - exact.reach, y = static_cast<double>(tip.y) + exact.drop;
    return std::sqrt(x * x + y * y + static_cast<double>(tip.z * tip.z)) / static_cast<double>(kLength);
}

TEST(Cantilever, TipRestsOnTheElastica) {
    for (const double share : {0.1, 0.4, 0.8}) {
        const double B = test::elasticaStiffness(share, kGravity, static_cast<double>(kLength));
        const test::ElasticaShape exact = test::solveElastica(B, kGravity, static_cast<double>(kLength));
        ASSERT_NEAR(exact.drop, share * static_cast<double>(kLength), 1e-6);
        double before = 1.0;
        for (const std::uint32_t segments : {8u, 16u, 32u}) {
            const double error = tipError(tipAtRest(cantilever(B), segments), exact);
            const std::string place = "drop " + std::to_string(std::lround(100 * share)) + " %, " +
                                      std::to_string(segments) + " segments";
            std::printf("tip error at %s: %.3f %% of the length\n", place.c_str(), 100 * error);
            if (segments == 32) {
                EXPECT_LE(error, 0.02) << place;
            }
            // Finer strands are nearer, down to what single precision leaves.
            EXPECT_LT(error, std::max(1.1 * before, 0.002)) << place;
            before = error;
        }
    }
}

TEST(Cantilever, AStrandThatIsStiffInOnePartBendsAsTheElasticaOfThatStiffness) {
    // Stiff for the first half and soft for the second, and the other way round, with a slope between.
    constexpr double kLow = 0.3, kFrom = 0.4, kTo = 0.6, kStiffness = 0.85;
    for (const bool stiffRoot : {true, false}) {
        const double before = stiffRoot ? 1.0 : kLow, behind = stiffRoot ? kLow : 1.0;
        SimulationSettings s = cantilever(0.0);
        s.angularStiffness = static_cast<float>(kStiffness);
        const Ramp::Key keys[] = {{0.0f, static_cast<float>(before)},
                                  {static_cast<float>(kFrom), static_cast<float>(before)},
                                  {static_cast<float>(kTo), static_cast<float>(behind)},
                                  {1.0f, static_cast<float>(behind)}};
        s.angularCurve = Ramp::of(keys);
        for (const std::uint32_t segments : {16u, 32u}) {
            // Shares count from the root, a segment before the end of the clamp.
            const double segment = static_cast<double>(kLength) / segments;
            const auto rod = [&](double from) {
                const double along = (from + segment) / (static_cast<double>(kLength) + segment);
                const double slope = std::clamp((along - kFrom) / (kTo - kFrom), 0.0, 1.0);
                const double setting = kStiffness * (before * (1.0 - slope) + behind * slope);
                return kHairBendingStiffness * setting / (1.0 - setting);
            };
            const auto exact = test::solveElastica(rod, kGravity, static_cast<double>(kLength));
            const auto even = test::solveElastica(kHairBendingStiffness * kStiffness / (1.0 - kStiffness),
                                                  kGravity, static_cast<double>(kLength));
            ASSERT_GT(std::abs(exact.drop - even.drop), 0.05 * static_cast<double>(kLength))
                << "tells them apart";
            const double error = tipError(tipAtRest(s, segments), exact);
            std::printf("%s, %u segments: the tip drops by %.1f %% of the length, error %.3f %%\n",
                        stiffRoot ? "stiff root" : "stiff tip", segments,
                        100 * exact.drop / static_cast<double>(kLength), 100 * error);
            EXPECT_LT(error, segments == 16 ? 0.03 : 0.02);
        }
    }
}

TEST(Cantilever, APresetBehavesTheSameWithAnyNumberOfSegments) {
    for (const float stiffness : {0.3f, 0.6f, 0.9f}) {
        SimulationSettings s = cantilever(0.0);
        s.angularStiffness = stiffness;
        s.angularCurve = springSettings().angularCurve;
        const Float3 fine = tipAtRest(s, 32);
        for (const std::uint32_t segments : {8u, 16u}) {
            const float apart = length(tipAtRest(s, segments) - fine) / kLength;
            std::printf("stiffness %.1f: tip with %u segments is %.2f %% of the length from that with 32\n",
                        static_cast<double>(stiffness), segments, 100.0 * static_cast<double>(apart));
            // Soft hair bends within its first few segments, which eight of them resolve coarsely.
            EXPECT_LT(apart, segments == 8 ? 0.05f : 0.02f) << stiffness << " with " << segments;
        }
    }
}

}  // namespace
}  // namespace hairloom::runtime
