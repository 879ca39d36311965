// SPDX-License-Identifier: GPL-3.0-or-later
// Hair held horizontally that bends under its own weight, against the heavy elastica.
#include <cstdio>

#include "tests/runtime/strand_fixture.h"
#include "tests/simulation/elastica.h"

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
    SimulationSettings s;
    s.angularStiffness = settingOf(B);
    s.angularTipShare = 1.0f;
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

TEST(Cantilever, TheTipComesToRestWhereTheElasticaHasIt) {
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

TEST(Cantilever, APresetBehavesTheSameWithAnyNumberOfSegments) {
    for (const float stiffness : {0.3f, 0.6f, 0.9f}) {
        SimulationSettings s = cantilever(0.0);
        s.angularStiffness = stiffness;
        s.angularTipShare = SimulationSettings{}.angularTipShare;
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
