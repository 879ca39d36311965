// SPDX-License-Identifier: GPL-3.0-or-later
// The methods that a simulation can run, behind one interface.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "core/base/parallel.h"
#include "core/simulation/simulation.h"
#include "core/simulation/strand_method.h"
#include "tests/support/spring_settings.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

/// Strands of 20 cm that hang from a row of roots.
Groom hangingHair(std::uint32_t strands = 6, std::uint32_t points = 10) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (std::uint32_t p = 0; p < points; ++p) {
            positions.emplace_back(0.01f * static_cast<float>(s),
                                   1.6f - 0.2f * static_cast<float>(p) / static_cast<float>(points - 1),
                                   0.1f);
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

constexpr SimulationMethod kMethods[] = {SimulationMethod::strands,   SimulationMethod::projective,
                                         SimulationMethod::chain,     SimulationMethod::lattice,
                                         SimulationMethod::particles, SimulationMethod::hybrid};

struct Outcome {
    std::vector<Vec3f> positions;
    SimulationStats stats;
};

Outcome run(const Groom& groom, std::string_view motionName, SimulationMethod method, int frames) {
    const auto motion = makeRigidMotion(motionName, groom);
    auto simulation = Simulation::make(groom, (*motion)->poseAt(0), {method, {}});
    EXPECT_TRUE(simulation.has_value());
    for (int f = 1; f <= frames; ++f)
        simulation->step(1.0f / 60.0f, (*motion)->poseAt(static_cast<float>(f) / 60.0f));
    const auto positions = simulation->positions_ws();
    return {{positions.begin(), positions.end()}, simulation->stats()};
}

float largestDistance(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    float largest = 0;
    for (std::size_t p = 0; p < a.size(); ++p) largest = std::max(largest, (a[p] - b[p]).norm());
    return largest;
}

TEST(Methods, HangingHairStaysAtRest) {
    const Groom groom = hangingHair();
    for (const SimulationMethod method : kMethods) {
        const Outcome still = run(groom, "none", method, 30);
        EXPECT_LT(largestDistance(still.positions, groom.positions()), 1e-4f) << static_cast<int>(method);
        EXPECT_EQ(still.stats.frames, 30u);
        EXPECT_EQ(still.stats.nanCount, 0u);
    }
}

TEST(Methods, EachMovesAndMeasuresItself) {
    const Groom groom = hangingHair();
    std::vector<Outcome> runs;
    for (const SimulationMethod method : kMethods) runs.push_back(run(groom, "nod", method, 30));
    for (const Outcome& moved : runs) {
        EXPECT_GT(largestDistance(moved.positions, groom.positions()), 0.005f);
        EXPECT_GT(moved.stats.energy, 0);
        EXPECT_GT(moved.stats.millisecondsPerFrame, 0);
        EXPECT_FALSE(moved.stats.effects.empty());
    }
    EXPECT_GT(largestDistance(runs[0].positions, runs[1].positions), 1e-3f) << "other methods, other motion";
    EXPECT_GT(largestDistance(runs[0].positions, runs[2].positions), 1e-4f);
    EXPECT_GT(largestDistance(runs[1].positions, runs[2].positions), 1e-3f);
    EXPECT_GT(largestDistance(runs[0].positions, runs[3].positions), 1e-3f);
    EXPECT_LT(runs[1].stats.maxStretch, 1e-4) << "sticks keep their length";
    EXPECT_LT(runs[2].stats.maxStretch, 1e-4) << "and rigid segments";
    EXPECT_GT(runs[3].stats.maxStretch, 1e-4) << "a lattice does not";
}

TEST(Methods, MeasurementsOfAnAlternativeAreThoseOfItsPoints) {
    Groom groom = hangingHair(1, 3);
    groom.simulation.collisionRadiusRoot = groom.simulation.collisionRadiusTip = 0;
    groom.spheres.push_back({"ball", Vec3f(0, 1.6f, 0.1f), 0.5f, ""});  // about the root: no way out
    const Outcome still = run(groom, "none", SimulationMethod::projective, 3);
    EXPECT_NEAR(still.stats.maxPenetrationMm, 300, 0.1);
    EXPECT_LT(still.stats.maxStretch, 1e-3);
}

TEST(Methods, TheLatticeStaysOutOfSpheres) {
    Groom groom = hangingHair();
    groom.simulation.collisionRadiusRoot = groom.simulation.collisionRadiusTip = 0.001f;
    const Outcome open = run(groom, "nod", SimulationMethod::lattice, 30);
    groom.spheres.push_back({"ball", Vec3f(0.02f, 1.42f, 0.1f), 0.03f, ""});
    const Outcome met = run(groom, "nod", SimulationMethod::lattice, 30);
    EXPECT_LT(met.stats.maxPenetrationMm, 0.01);
    EXPECT_GT(largestDistance(met.positions, open.positions), 0.02f);
}

/// Strands that stand out from a ball in all directions.
Groom ballOfHair(std::uint32_t strands) {
    constexpr std::uint32_t kPoints = 10;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < strands; ++s) {
        const float height = 1 - 2 * (static_cast<float>(s) + 0.5f) / static_cast<float>(strands);
        const float angle = 2.39996f * static_cast<float>(s), across = std::sqrt(1 - height * height);
        const Vec3f out(across * std::cos(angle), height, across * std::sin(angle));
        for (std::uint32_t p = 0; p < kPoints; ++p)
            positions.push_back(Vec3f(0, 1.6f, 0) + out * (0.06f + 0.015f * static_cast<float>(p)));
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    groom.spheres.push_back({"ball", Vec3f(0, 1.6f, 0), 0.058f, ""});
    return groom;
}

/// Litres: boxes of 15 mm that have a point.
double volumeOf(std::span<const Vec3f> points) {
    std::set<std::array<long, 3>> boxes;
    for (const Vec3f& p : points)
        boxes.insert({std::lround(p.x() / 0.015f), std::lround(p.y() / 0.015f), std::lround(p.z() / 0.015f)});
    return static_cast<double>(boxes.size()) * 0.015 * 0.015 * 0.015 * 1e3;
}

/// Soft hair that was never authored to hang falls onto itself. As a continuum it resists.
TEST(Methods, ContinuaKeepTheVolumeOfABallOfHair) {
    Groom groom = ballOfHair(400);
    groom.simulation.angularStiffness = 0.02f;
    groom.simulation.restGravity = 0;
    const double start = volumeOf(groom.positions());
    const double alone = volumeOf(run(groom, "none", SimulationMethod::strands, 90).positions);
    for (const SimulationMethod method : {SimulationMethod::particles, SimulationMethod::hybrid}) {
        const Outcome kept = run(groom, "none", method, 90);
        EXPECT_GT(volumeOf(kept.positions), 1.1 * alone) << static_cast<int>(method) << ", from " << start;
        EXPECT_EQ(kept.stats.nanCount, 0u);
        EXPECT_LT(kept.stats.maxStretch, 1e-3) << "strands keep their lengths";
    }
}

TEST(Methods, AlternativesDoNotDependOnThreads) {
    const Groom groom = hangingHair(40);
    const std::size_t before = threadCount();
    for (const SimulationMethod method : kMethods) {
        setThreadCount(1);
        const std::uint64_t one = run(groom, "spin", method, 10).stats.stateHash;
        setThreadCount(4);
        EXPECT_EQ(run(groom, "spin", method, 10).stats.stateHash, one);
        EXPECT_NE(run(groom, "nod", method, 10).stats.stateHash, one);
    }
    setThreadCount(before);
}

TEST(Methods, TheLatticeTakesAirAndGravityFromTheSettings) {
    runtime::SimulationSettings settings = runtime::springSettings();
    settings.gravity = {1, 2, 3};
    settings.airDrag = 7;
    settings.windDirection = {0, 0, 0.5f};
    settings.windSpeed = 4;
    settings.substeps = 3;
    settings.latticeNodes = 9;
    settings.latticeRootFrequency = 11;
    settings.latticeTipFrequency = 2.5f;
    settings.latticeCouplingFrequency = 0.5f;
    settings.collisionRadiusTip = 0.01f;
    const runtime::LatticeSettings lattice = latticeSettings(settings);
    EXPECT_EQ(lattice.nodes, 9u);
    EXPECT_EQ(lattice.rootFrequency, 11);
    EXPECT_EQ(lattice.tipFrequency, 2.5f);
    EXPECT_EQ(lattice.couplingFrequency, 0.5f);
    EXPECT_EQ(lattice.collisionRadiusTip, 0.01f);
    EXPECT_EQ(lattice.gravity, settings.gravity);
    EXPECT_EQ(lattice.airDrag, 7);
    EXPECT_EQ(lattice.wind, (runtime::Float3{0, 0, 4}));
    EXPECT_EQ(lattice.substeps, 3u);
}

TEST(SceneInput, TheHeadIsTheMotionOfItsRoots) {
    const Groom groom = hangingHair();
    const auto scene = SceneInput::make(groom);
    ASSERT_TRUE(scene.has_value());
    HeadPose pose;
    pose.head_ws = Eigen::Translation3f(0.3f, -0.2f, 0.1f) * Eigen::AngleAxisf(2.0f, Vec3f(1, 2, 2) / 3);
    const runtime::RootFrame head = scene->headAt(pose);
    const Vec3f shift = pose.head_ws.translation();
    EXPECT_NEAR(head.position.x, shift.x(), 1e-5f);
    EXPECT_NEAR(head.position.y, shift.y(), 1e-5f);
    EXPECT_NEAR(head.position.z, shift.z(), 1e-5f);
    const Quatf rotation(head.rotation.w, head.rotation.x, head.rotation.y, head.rotation.z);
    EXPECT_NEAR(rotation.angularDistance(Quatf(pose.head_ws.linear())), 0, 1e-3f);
}

/// Points that take velocities, without forces of their own.
struct FreePoints {
    std::vector<runtime::Float3> positions, speeds;
    std::size_t pointCount() const { return positions.size(); }
    void readPositions(std::span<runtime::Float3> into) const { std::ranges::copy(positions, into.begin()); }
    void readVelocities(std::span<runtime::Float3> into) const { std::ranges::copy(speeds, into.begin()); }
    void addVelocities(std::span<const runtime::Float3> changes) {
        for (std::size_t p = 0; p < speeds.size(); ++p) speeds[p] = speeds[p] + changes[p];
    }
};

TEST(HairHair, FrictionBringsNeighboursTogetherAndKeepsTheirMomentum) {
    FreePoints points{{{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {-0.5f, 0, 0}}};
    runtime::HairVolumeSettings settings;
    settings.repulsion = 0;
    auto made = runtime::HairVolume::make(settings);
    ASSERT_TRUE(made.volume.has_value());
    pushHairApart(points, *made.volume, 0.1f);
    const float left = std::exp(-settings.friction * 0.1f);
    EXPECT_NEAR(points.speeds[0].x - points.speeds[1].x, 1.5f * left, 1e-4f);
    EXPECT_NEAR(points.speeds[0].x + points.speeds[1].x, 0.5f, 1e-4f);
}

TEST(HairHair, MethodsThatTakeNoVelocitiesRefuseIt) {
    const Groom groom = hangingHair();
    for (const SimulationMethod method :
         {SimulationMethod::projective, SimulationMethod::chain, SimulationMethod::lattice,
          SimulationMethod::particles, SimulationMethod::hybrid}) {
        const auto made = Simulation::make(groom, {}, {method, runtime::HairVolumeSettings{}});
        ASSERT_FALSE(made.has_value());
        EXPECT_THAT(made.error().message(), HasSubstr("velocities"));
    }
    const auto engine =
        Simulation::make(groom, {}, {SimulationMethod::strands, runtime::HairVolumeSettings{}});
    EXPECT_EQ(engine.has_value(), TakesVelocities<runtime::Engine>);
}

/// The head is seen at the quarters of a step: a step of 1/30 s is its four quarters.
TEST(HeadSteps, AreTheirFourQuarters) {
    Groom groom = hangingHair();
    groom.spheres = {{"ball", Vec3f(0.02f, 1.5f, 0.1f), 0.03f, ""}};
    const auto motion = makeRigidMotion("nod", groom);
    auto whole = Simulation::make(groom, (*motion)->poseAt(0));
    auto quarters = Simulation::make(groom, (*motion)->poseAt(0));
    auto ends = Simulation::make(groom, (*motion)->poseAt(0));
    ASSERT_TRUE(whole && quarters && ends);
    constexpr float kStep = 1.0f / 30;
    HeadPose before = (*motion)->poseAt(0);
    for (int f = 1; f <= 20; ++f) {
        const float from = static_cast<float>(f - 1) * kStep, to = static_cast<float>(f) * kStep;
        HeadStep head = stepOf(**motion, before, from, to);
        ASSERT_EQ(head.within.size(), kPosesWithin);
        whole->step(kStep, head);
        ends->step(kStep, head.end);
        for (const HeadPose& pose : head.within) quarters->step(kStep / 4, pose);
        quarters->step(kStep / 4, head.end);
        before = std::move(head.end);
    }
    EXPECT_EQ(whole->stats().stateHash, quarters->stats().stateHash);
    EXPECT_GT(largestDistance(whole->positions_ws(), ends->positions_ws()), 1e-4f);
}

TEST(HeadSteps, AHeadThatStaysHasNoPosesWithin) {
    const Groom groom = hangingHair();
    const auto still = makeRigidMotion("none", groom), nod = makeRigidMotion("nod", groom);
    EXPECT_TRUE(stepOf(**still, (*still)->poseAt(0), 0, 0.1f).within.empty());
    EXPECT_EQ(stepOf(**nod, (*nod)->poseAt(0), 0, 0.1f).within.size(), kPosesWithin);
    // Back where it was at the end, after half a swing.
    EXPECT_EQ(stepOf(**nod, (*nod)->poseAt(0), 0, 0.8f).within.size(), kPosesWithin);
    HeadPose turned = (*nod)->poseAt(0.1f);
    EXPECT_FALSE(isSamePlace((*nod)->poseAt(0), turned));
    turned.wind_ws = Vec3f::UnitX();
    EXPECT_TRUE(isSamePlace((*nod)->poseAt(0.1f), turned));
}

}  // namespace
}  // namespace hairloom
