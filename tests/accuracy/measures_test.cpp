// SPDX-License-Identifier: GPL-3.0-or-later
// Quartiles, fronts, material points and the distance between two runs, on cases that are known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/accuracy/grid.h"
#include "core/accuracy/ground_truth.h"
#include "core/cost/statistics.h"
#include "tests/accuracy/hair.h"
#include "tests/support/spring_settings.h"

namespace hairloom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Statistics, QuartilesInterpolateBetweenNeighbours) {
    const Quartiles of = quartiles({4, 1, 3, 2});
    EXPECT_DOUBLE_EQ(of.q1, 1.75);
    EXPECT_DOUBLE_EQ(of.median, 2.5);
    EXPECT_DOUBLE_EQ(of.q3, 3.25);
    EXPECT_DOUBLE_EQ(quartiles({7}).q3, 7);
}

TEST(Statistics, TheFrontIsWhatNothingBeats) {
    // The second is beaten by the first, the fourth by the third; the last two are no results.
    EXPECT_THAT(paretoFront({{1, 5}, {2, 6}, {3, 2}, {3, 4}, {9, 1}, {kInfinity, 0}, {0.5, std::nan("")}}),
                ElementsAre(true, false, true, false, true, false, false));
    EXPECT_THAT(paretoFront({{1, 1}, {1, 1}, {1, 2}}), ElementsAre(true, true, false))
        << "equals stand together";
    EXPECT_THAT(paretoFront({}), ElementsAre());
}

TEST(Statistics, TheFrontAgreesWithItsDefinition) {
    std::vector<std::pair<double, double>> pairs;
    for (int i = 0; i < 60; ++i) pairs.emplace_back(i * 37 % 17, i * 23 % 13);
    const std::vector<bool> front = paretoFront(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        bool beaten = false;
        for (const auto& other : pairs) {
            beaten = beaten ||
                     (other.first <= pairs[i].first && other.second <= pairs[i].second && other != pairs[i]);
        }
        EXPECT_EQ(front[i], !beaten) << i;
    }
}

Trajectory trajectoryOf(std::vector<Vec3f> points) {
    return {1, points.size(), std::move(points), true};
}

TEST(Errors, AreTheDistanceInMillimetres) {
    const Trajectory groundTruth =
        trajectoryOf({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(2, 1, 0), Vec3f(0, 0, 3)});
    Trajectory moved = groundTruth;
    for (Vec3f& point : moved.points_ws) point += Vec3f(0.003f, 0, 0.004f);
    EXPECT_NEAR(compare(moved, groundTruth).rmsMm, 5, 1e-3);
    EXPECT_NEAR(compare(moved, groundTruth).maxMm, 5, 1e-3);
    moved = groundTruth;
    moved.points_ws[2].y() += 0.01f;  // one of four: √(10²/4)
    EXPECT_NEAR(compare(moved, groundTruth).rmsMm, 5, 1e-3);
    EXPECT_NEAR(compare(moved, groundTruth).maxMm, 10, 1e-3);
    EXPECT_EQ(compare(groundTruth, groundTruth).maxMm, 0);
}

TEST(Hair, SharesFollowTheArcLength) {
    const Groom groom = makeGroom({0, 3}, {Vec3f(0, 0, 0), Vec3f(0, -1, 0), Vec3f(3, -1, 0)});
    EXPECT_THAT(sampleStrands(groom, 1, 1).arcShares, ElementsAre(0.0f, 0.25f, 1.0f));
}

TEST(Hair, ResamplingIsEvenInArcLength) {
    const Groom groom = makeGroom({0, 3}, {Vec3f(0, 0, 0), Vec3f(0, -1, 0), Vec3f(3, -1, 0)});
    const SceneHair five = resampledHair(sampleStrands(groom, 1, 1), 5);
    EXPECT_THAT(five.arcShares, ElementsAre(0.0f, 0.25f, 0.5f, 0.75f, 1.0f));
    const auto strand = five.groom.strand(0);
    ASSERT_EQ(strand.size(), 5u);
    const Vec3f expected[] = {{0, 0, 0}, {0, -1, 0}, {1, -1, 0}, {2, -1, 0}, {3, -1, 0}};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_LT((strand[i] - expected[i]).norm(), 1e-5f) << i;
}

TEST(Hair, SamplesAreSeededOrderedAndKeepTheirAttributes) {
    Groom groom = straightHair(40, 5);
    std::vector<std::uint32_t> ids;
    for (std::uint32_t s = 0; s < 40; ++s) ids.push_back(s);
    groom.strandAttributes.set(attribute::kStrandId, ids);
    const auto drawn = [&](std::uint64_t seed) {
        const SceneHair hair = sampleStrands(groom, 7, seed);
        const auto view = hair.groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
        return std::vector<std::uint32_t>(view.begin(), view.end());
    };
    const std::vector<std::uint32_t> first = drawn(3);
    EXPECT_EQ(first.size(), 7u);
    EXPECT_TRUE(std::ranges::is_sorted(first));
    EXPECT_EQ(std::ranges::adjacent_find(first), first.end());
    EXPECT_EQ(first, drawn(3));
    EXPECT_NE(first, drawn(4));
    const SceneHair hair = sampleStrands(groom, 7, 3);
    for (std::size_t s = 0; s < 7; ++s) {
        EXPECT_EQ(hair.groom.strand(s)[4], groom.strand(first[s])[4]);
    }
    EXPECT_EQ(sampleStrands(groom, 100, 3).groom.strandCount(), 40u);
}

/// Without forces hair stays where it is carried, whatever its points: material points of coarse and fine
/// strands are the same positions.
TEST(Hair, MaterialPointsDoNotDependOnTheNumberOfPoints) {
    Groom groom = straightHair(3, 9);
    groom.simulation.gravity = {};
    groom.simulation.airDrag = 0;
    const auto motion = makeRigidMotion("none", groom);
    const SceneTime time{.frames = 2};
    const auto poses = posesOf(**motion, time);
    const SceneHair own = sampleStrands(groom, 3, 1);
    const Followed followed{{0, 1, 2}, evenShares(5)};
    const auto fine = runScene(own, poses, time, followed);
    const auto coarse = runScene(resampledHair(own, 4), poses, time, followed);
    ASSERT_TRUE(fine && coarse);
    EXPECT_EQ(fine->trajectory.points_ws.size(), 2u * 3u * 5u);
    EXPECT_LT(compare(coarse->trajectory, fine->trajectory).maxMm, 1e-2);
    const Vec3f tip = groom.strand(1).back();
    EXPECT_LT((fine->trajectory.points_ws[9] - tip).norm(), 1e-5f) << "the last share is the tip";
}

/// Angle below the horizontal of a pendulum of length `length` that was let go there, after `time` seconds:
/// θ'' = (g/L) cos θ, by the classical Runge-Kutta method in double precision.
double pendulumAngle(double length, double time) {
    constexpr int kSteps = 20000;
    const double h = time / kSteps, rate = 9.81 / length;
    double angle = 0, speed = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double a1 = rate * std::cos(angle), v1 = speed;
        const double a2 = rate * std::cos(angle + h / 2 * v1), v2 = speed + h / 2 * a1;
        const double a3 = rate * std::cos(angle + h / 2 * v2), v3 = speed + h / 2 * a2;
        const double a4 = rate * std::cos(angle + h * v3), v4 = speed + h * a3;
        angle += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
        speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return angle;
}

/// A pendulum of one segment, let go level.
Groom pendulum() {
    Groom groom = straightHair(1, 2);
    groom.simulation.clampedPoints = 1;
    groom.simulation.angularStiffness = 0;
    groom.simulation.airDrag = 0;
    groom.simulation.dampingTime = 0;
    return groom;
}

/// The middle and the tip of that pendulum in each frame, in the form of `like`.
Trajectory pendulumTrajectory(const Groom& groom, const Trajectory& like) {
    Trajectory exact = like;
    for (std::uint32_t frame = 0; frame < like.frames; ++frame) {
        const double angle = pendulumAngle(0.2, (frame + 1) / 60.0);
        const Vec3f tip(static_cast<float>(0.2 * std::cos(angle)),
                        static_cast<float>(1.6 - 0.2 * std::sin(angle)), 0);
        exact.points_ws[2 * frame] = 0.5f * (tip + groom.strand(0)[0]);
        exact.points_ws[2 * frame + 1] = tip;
    }
    return exact;
}

TEST(GroundTruth, APendulumSwingsAsTheEquationSays) {
    const Groom groom = pendulum();
    const auto motion = makeRigidMotion("none", groom);
    const SceneTime time{.frames = 30};
    const auto groundTruth =
        EngineConverged(32).compute(sampleStrands(groom, 1, 1), **motion, time, {{0}, {0.5f, 1}});
    ASSERT_TRUE(groundTruth.has_value());
    ASSERT_EQ(groundTruth->trajectory.points_ws.size(), 2u * 30u);
    // The engine is of first order here, so the change of the last doubling is about the error that is left;
    // the tip swings 400 mm.
    const TrajectoryError error =
        compare(groundTruth->trajectory, pendulumTrajectory(groom, groundTruth->trajectory));
    EXPECT_LT(error.maxMm, 3.0);
    EXPECT_GT(groundTruth->uncertaintyMm, 0.2 * error.rmsMm);
    EXPECT_LT(groundTruth->uncertaintyMm, 2.0);
    EXPECT_THAT(groundTruth->detail, HasSubstr("mm at 32"));
}

TEST(GroundTruth, TheReferenceSwingsAsTheEquationSays) {
    const Groom groom = pendulum();
    const auto motion = makeRigidMotion("none", groom);
    const SceneTime time{.frames = 30};
    const ReferenceConverged source;
    const auto groundTruth = source.compute(sampleStrands(groom, 1, 1), **motion, time, {{0}, {0.5f, 1}});
    ASSERT_TRUE(groundTruth.has_value());
    ASSERT_EQ(groundTruth->trajectory.points_ws.size(), 2u * 30u);
    const TrajectoryError error =
        compare(groundTruth->trajectory, pendulumTrajectory(groom, groundTruth->trajectory));
    EXPECT_LT(error.maxMm, 0.01);
    EXPECT_LT(groundTruth->uncertaintyMm, 0.01);
    EXPECT_THAT(groundTruth->detail, HasSubstr("1 of 1 strands converged"));
}

TEST(GroundTruth, TheReferenceSaysWhatItLeavesOut) {
    Groom groom = straightHair(3, 6);
    groom.simulation = runtime::springSettings();
    groom.simulation.lengthMethod = runtime::LengthMethod::springs;
    const auto motion = makeRigidMotion("nod", groom);
    const SceneTime time{.frames = 3};
    const ReferenceConverged source({.strands = 2, .toleranceMm = 1e-9, .maxSubsteps = 4});
    EXPECT_EQ(source.maxStrands(), 2u);
    const auto groundTruth = source.compute(sampleStrands(groom, 3, 1), **motion, time, {{0, 2}, {0.5f, 1}});
    ASSERT_TRUE(groundTruth.has_value()) << groundTruth.error().message();
    EXPECT_EQ(groundTruth->followed.strands.size(), 2u);
    EXPECT_EQ(groundTruth->trajectory.points_ws.size(), 3u * 2u * 2u);
    EXPECT_THAT(groundTruth->detail, HasSubstr("0 of 2 strands converged"));
    EXPECT_THAT(groundTruth->detail, HasSubstr("last doubling moved"));
    for (const char* const note : {"does not sleep", "coil springs", "refined until that changed"})
        EXPECT_THAT(groundTruth->notes, testing::Contains(HasSubstr(note)));
    groom.simulation.angularStiffness = 1;
    EXPECT_FALSE(source.compute(sampleStrands(groom, 3, 1), **motion, time, {{0}, {1}}).has_value());
}

/// Only spheres that a strand can reach count, and they do.
TEST(GroundTruth, TheReferenceMeetsSpheres) {
    Groom groom = straightHair(2, 8);
    groom.spheres.push_back({"ball", Vec3f(0.1f, 1.53f, 0), 0.05f, ""});
    groom.spheres.push_back({"far", Vec3f(9, 9, 9), 0.05f, ""});
    const auto motion = makeRigidMotion("none", groom);
    const SceneTime time{.frames = 15};
    Groom loose = groom;
    loose.simulation.angularStiffness = 0;
    const auto met = ReferenceConverged().compute(sampleStrands(loose, 2, 1), **motion, time, {{0}, {0.5f}});
    loose.spheres.clear();
    const auto free = ReferenceConverged().compute(sampleStrands(loose, 2, 1), **motion, time, {{0}, {0.5f}});
    ASSERT_TRUE(met && free);
    const Vec3f centre(0.1f, 1.53f, 0);
    for (const Vec3f& place : met->trajectory.points_ws) EXPECT_GT((place - centre).norm(), 0.048f);
    EXPECT_LT((free->trajectory.points_ws.back() - centre).norm(), 0.1f);
    EXPECT_GT(compare(met->trajectory, free->trajectory).maxMm, 10);
}

TEST(Grid, AxesAreReadByTheNamesOfFields) {
    const auto integrators = parseAxis("integrator", {"rk4", "verlet"});
    ASSERT_TRUE(integrators.has_value());
    EXPECT_EQ(axisValueText(*integrators, integrators->values[0]), "rk4");
    runtime::SimulationSettings settings = runtime::springSettings();
    applyValues({*integrators}, {integrators->values[0]}, settings);
    EXPECT_EQ(settings.integrator, runtime::Integrator::rk4);
    const auto stiffness = parseAxis("angularStiffness", {"0.25", "0.5", "0.25"});
    ASSERT_TRUE(stiffness.has_value());
    EXPECT_THAT(stiffness->values, ElementsAre(0.25, 0.5)) << "once each";
    EXPECT_EQ(combinations({*integrators, *stiffness}).size(), 4u);
    EXPECT_THAT(combinations({*integrators, *stiffness})[1], ElementsAre(integrators->values[0], 0.5));
}

TEST(Grid, WhatIsWrongIsRefusedWithWhatWasExpected) {
    const auto former = parseAxis("pearlRadiusTip", {"0.002"});
    ASSERT_TRUE(former) << former.error().message();
    EXPECT_EQ(former->field, "collisionRadiusTip");
    EXPECT_EQ(parseAxis("angularMethod", {"cheap", "exact"})->values,
              parseAxis("angularMethod", {"smallAngle", "exact"})->values);
    EXPECT_THAT(parseAxis("integrator", {"guess"}).error().message(), HasSubstr("velocityVerlet"));
    EXPECT_THAT(parseAxis("substeps", {"0"}).error().message(), HasSubstr("1 to 256"));
    EXPECT_THAT(parseAxis("substeps", {"4x"}).error().message(), HasSubstr("number"));
    EXPECT_THAT(parseAxis("substeps", {"1.5"}).error().message(), HasSubstr("1.5"));
    EXPECT_THAT(parseAxis("points", {"1"}).error().message(), HasSubstr("2 to 512"));
    EXPECT_THAT(parseAxis("gravity", {"1"}).error().message(), HasSubstr("one number"));
    EXPECT_THAT(parseAxis("beard", {"1"}).error().message(), HasSubstr("beard"));
    EXPECT_FALSE(parseAxis("substeps", {}).has_value());
}

}  // namespace
}  // namespace hairloom::test
