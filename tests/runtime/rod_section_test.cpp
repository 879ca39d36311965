// SPDX-License-Identifier: GPL-3.0-or-later
// Rods of a flat section: they bend by the two moments of area of their ellipse, and keep what round ones
// keep.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hairloom/presets.h"
#include "models/rods/rods.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

SimulationSettings flatRods(float ratio) {
    SimulationSettings s;
    s.strandModel = StrandModel::rods;
    s.angularStiffness = 0.5f;
    s.angularCurve = Ramp();
    s.restGravity = 0.0f;
    s.sleepSpeed = 0.0f;
    s.substeps = 2;
    s.sectionRatio = ratio;
    return s;
}

/// Moments of area about the long and the short diameter of an ellipse of area π, by the midpoint rule.
struct Moments {
    double aboutLong = 0.0, aboutShort = 0.0;
};
Moments momentsOf(double ratio) {
    const double a = 1.0 / std::sqrt(ratio), b = std::sqrt(ratio);
    constexpr int kSteps = 2000;
    Moments found;
    for (int i = 0; i < kSteps; ++i) {
        const double x = a * (2.0 * (i + 0.5) / kSteps - 1.0), half = b * std::sqrt(1.0 - x * x / (a * a));
        const double width = 2.0 * a / kSteps;
        found.aboutLong += width * 2.0 * half * half * half / 3.0;
        found.aboutShort += width * 2.0 * half * x * x;
    }
    return found;
}

TEST(RodSection, RatiosAreThoseOfAnEllipse) {
    constexpr double kRound = std::numbers::pi / 4.0;  // I of a circle of radius 1
    for (const float ratio : {1.0f, 0.8f, 0.5f, 0.2f}) {
        const RodSectionRatios section = rodSectionRatios(flatRods(ratio));
        const Moments moments = momentsOf(static_cast<double>(ratio));
        EXPECT_NEAR(section.stiffer, moments.aboutShort / kRound, 1e-3 * section.stiffer) << ratio;
        EXPECT_NEAR(section.stiffer * (1.0 + section.flat), moments.aboutLong / kRound, 1e-3) << ratio;
        // Saint-Venant's J of an ellipse is 4 I₁ I₂ / (I₁ + I₂), of a circle 2 I.
        const double torsion = 4.0 * moments.aboutLong * moments.aboutShort /
                               (moments.aboutLong + moments.aboutShort) / (2.0 * kRound);
        EXPECT_NEAR(section.stiffer * (1.0 + section.twist), 0.75 * torsion, 1e-3) << ratio;
    }
}

/// The beam's own formula for a small load: the tip sinks by g L⁴/8B, about each diameter by its own B.
TEST(RodSection, ALevelStrandSinksByTheBeamsFormula) {
    constexpr float kLength = 0.02f;
    constexpr std::uint32_t kPoints = 41;
    Strands strand;
    strand.add({}, {0.0f, 0.0f, 1.0f}, kLength / (kPoints - 1), kPoints);
    const double softest = 9.81 * std::pow(double{kLength}, 4) / 8.0 / kHairBendingStiffness;
    for (const float ratio : {1.0f, 0.5f, 0.25f}) {
        for (const Float3 down :
             {Float3{0.0f, -1.0f, 0.0f}, Float3{-1.0f, 0.0f, 0.0f}, Float3{-0.6f, -0.8f, 0.0f}}) {
            SimulationSettings s = flatRods(ratio);
            s.gravity = down * 9.81f;
            Engine engine = makeEngine(strand, s);
            run(engine, strand, 400);
            const Float3 sunk = positionsOf(engine).back() - strand.points.back();
            // The long diameter of straight hair is the root's x: bending along y is about it.
            const double alongY = softest / static_cast<double>(ratio) * static_cast<double>(down.y);
            const double alongX = softest * static_cast<double>(ratio) * static_cast<double>(down.x);
            EXPECT_NEAR(static_cast<double>(sunk.y), alongY, 0.03 * std::abs(alongY) + 2e-7) << ratio;
            EXPECT_NEAR(static_cast<double>(sunk.x), alongX, 0.03 * std::abs(alongX) + 2e-7) << ratio;
        }
    }
}

Strands curl(double radius, double pitch, double turns) {
    Strands strand;
    constexpr int kSegments = 60;
    for (int p = 0; p <= kSegments; ++p) {
        const double t = 2.0 * std::numbers::pi * turns * p / kSegments;
        strand.points.push_back({static_cast<float>(radius * (std::cos(t) - 1.0)),
                                 static_cast<float>(-pitch * t / (2.0 * std::numbers::pi)),
                                 static_cast<float>(radius * std::sin(t))});
    }
    strand.offsets.push_back(static_cast<std::uint32_t>(strand.points.size()));
    return strand;
}

/// A bow in its own plane bends about the long diameter of its section, however the root stands: it opens as
/// round hair of that stiffness does.
TEST(RodSection, CurlsBendAboutTheLongDiameter) {
    const Strands bow = curl(0.01, 0.0, 0.75);
    const float ratio = 0.5f;
    SimulationSettings flat = flatRods(ratio), softer = flatRods(1.0f), stiffer = flatRods(1.0f);
    flat.angularStiffness = 0.6f;
    const double stiffness = 0.6 / 0.4;  // B/B₀, as s/(1 − s)
    const auto asRound = [&](double share) { return static_cast<float>(share / (1.0 + share)); };
    softer.angularStiffness = asRound(stiffness * double{ratio});
    stiffer.angularStiffness = asRound(stiffness / double{ratio});
    const auto opened = [&](const SimulationSettings& settings) {
        SimulationSettings s = settings;
        s.gravity = {0.0f, 0.0f, -9.81f};  // in the plane of the bow
        Engine engine = makeEngine(bow, s);
        run(engine, bow, 600);
        return length(positionsOf(engine).back() - bow.points.back());
    };
    const float moved = opened(flat);
    EXPECT_NEAR(moved / opened(softer), 1.0f, 0.05f);
    EXPECT_GT(moved / opened(stiffer), 2.0f);
}

TEST(RodSection, FlatCurlsHoldTheirShapeAndComeBack) {
    const Strands strand = curl(0.008, 0.02, 4.0);
    for (const float ratio : {0.8f, 0.5f, 0.2f}) {
        SimulationSettings s = flatRods(ratio);
        s.restGravity = 1.0f;
        Engine engine = makeEngine(strand, s);
        run(engine, strand, 60);
        EXPECT_LT(length(positionsOf(engine).back() - strand.points.back()), 5e-6f) << ratio;
        for (int frame = 0; frame < 60; ++frame) {
            const auto t = static_cast<float>(frame);
            const std::vector<RootFrame> roots =
                strand.roots({0.05f * std::sin(0.7f * t), 0.0f, 0.05f * std::cos(0.9f * t)},
                             turnAbout({0.0f, 1.0f, 0.0f}, 0.2f * t));
            engine.step({1.0f / 60.0f, frame / 60.0, roots});
        }
        run(engine, strand, 900);
        float farthest = 0.0f;
        const std::vector<Float3> now = positionsOf(engine);
        for (std::size_t p = 0; p < now.size(); ++p)
            farthest = std::max(farthest, length(now[p] - strand.points[p]));
        EXPECT_LT(farthest, 1e-3f) << ratio;
    }
}

}  // namespace
}  // namespace hairloom::runtime
