// SPDX-License-Identifier: GPL-3.0-or-later
// The reference's bending against the heavy elastica.

#include "tests/simulation/elastica.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/simulation/reference_fixture.h"

namespace hairloom {
namespace {

using namespace test;

TEST(Elastica, ShootingAgreesWithTheLinearBeamAndWithItself) {
    // A stiff beam drops by g L⁴/(8 B).
    const double g = 9.81, L = 0.2, stiff = 10.0;
    const ElasticaShape shape = solveElastica(stiff, g, L);
    EXPECT_NEAR(shape.drop / (g * std::pow(L, 4) / (8.0 * stiff)), 1.0, 1e-6);
    EXPECT_NEAR(shape.curvatureAtEnd, 0.0, 1e-12);
    for (const double share : {0.1, 0.4, 0.8}) {
        const ElasticaShape bent = solveElastica(elasticaStiffness(share, g, L), g, L);
        EXPECT_NEAR(bent.drop / L, share, 1e-9);
        EXPECT_LT(std::hypot(bent.reach, bent.drop), L);
        EXPECT_NEAR(bent.curvatureAtEnd, 0.0, 1e-9);
    }
}

constexpr double kLength = 0.2;  // m, of the free beam

/// Distance of the tip of a strand at rest from that of the elastica, as a share of the free length.
double tipError(std::size_t freeSegments, double stiffness, runtime::AngularMethod method) {
    const double L = kLength;
    runtime::SimulationSettings s = bareSettings();
    s.clampedPoints = 2;
    s.dampingTime = 0.05f;
    s.angularMethod = method;
    const double wanted = stiffness / runtime::kHairBendingStiffness;
    s.angularStiffness = static_cast<float>(wanted / (1.0 + wanted));
    const double B = reference::bendingStiffness(static_cast<double>(s.angularStiffness));

    // The free beam starts at point 1.
    const double segment = L / static_cast<double>(freeSegments);
    reference::Solver solver = solverOf(straightStrand(freeSegments + 1, L + segment), s);
    double speed = 1.0;
    for (int frame = 0; frame < 600 && speed > 1e-9; ++frame) {
        const reference::StepReport report = solver.step(stillFrame(1.0 / 60.0), {1, 1});
        EXPECT_EQ(report.failed, 0u) << "frame " << frame;
        speed = 0.0;
        for (const Vec3d& v : solver.velocities_ws()) speed = std::max(speed, v.norm());
    }
    EXPECT_LT(speed, 1e-8) << freeSegments << " segments have not come to rest";
    const ElasticaShape right = solveElastica(B, kGravity, L);
    const Vec3d tip = solver.positions_ws().back() - Vec3d(segment + right.reach, -right.drop, 0.0);
    return tip.norm() / L;
}

TEST(Elastica, CantileverComesToRestOnIt) {
    std::printf("tip error, %% of the length\n%10s %10s %10s %10s %10s\n", "drop", "8", "16", "32", "64");
    for (const double drop : {0.1, 0.4, 0.8}) {
        const double stiffness = elasticaStiffness(drop, kGravity, kLength);
        std::vector<double> errors;
        for (const std::size_t segments : {8u, 16u, 32u, 64u})
            errors.push_back(tipError(segments, stiffness, runtime::AngularMethod::implicit));
        std::printf("%9.0f%% %10.4f %10.4f %10.4f %10.4f\n", 100.0 * drop, 100.0 * errors[0],
                    100.0 * errors[1], 100.0 * errors[2], 100.0 * errors[3]);
        EXPECT_LE(errors[2], 0.02);
        for (std::size_t i = 0; i + 1 < errors.size(); ++i) EXPECT_LT(errors[i + 1], 0.5 * errors[i]);
    }
}

TEST(Elastica, ExactDirectionBendsAlike) {
    // Lengths are held: what the small-angle method adds along a segment the tension takes.
    const double stiffness = elasticaStiffness(0.4, kGravity, kLength);
    EXPECT_NEAR(tipError(16, stiffness, runtime::AngularMethod::exact),
                tipError(16, stiffness, runtime::AngularMethod::smallAngle), 1e-7);
}

}  // namespace
}  // namespace hairloom
