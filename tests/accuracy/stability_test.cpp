// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/stability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/stability/stability_map.h"
#include "core/stability/stability_report.h"
#include "hairloom/stable.h"
#include "tests/accuracy/xml_check.h"
#include "tests/support/spring_settings.h"

namespace hairloom {

void PrintTo(const HardCase& hardCase, std::ostream* out) {
    *out << hardCase.number << " " << hardCase.name;
}

namespace {

using runtime::Integrator;
using testing::HasSubstr;

StabilityOptions quick() {
    StabilityOptions options;
    options.stepsAtRest = 50'000;
    return options;
}

std::string describe(const StabilityResult& r) {
    std::string text;
    for (const StabilityThreshold& m : r.thresholds) {
        if (!m.met())
            text += m.what + " " + std::to_string(m.worst) + " of " + std::to_string(m.threshold) + " " +
                    m.unit + "; ";
    }
    return text;
}

TEST(HardCaseTable, HasItsCasesByNumber) {
    std::set<std::string> names;
    ASSERT_EQ(hardCases().size(), 30u);
    for (std::size_t i = 0; i < hardCases().size(); ++i) {
        EXPECT_EQ(hardCases()[i].number, static_cast<int>(i) + 1);
        names.insert(hardCases()[i].name);
    }
    EXPECT_EQ(names.size(), 30u);
}

class HardCaseTest : public testing::TestWithParam<HardCase> {};

TEST_P(HardCaseTest, OfSpringsPositionVerletHolds) {
    const StabilityResult result = runHardCase(GetParam(), springsWith(Integrator::verlet), quick());
    // Curves, masses that differ 10,000 times, energy without damping, storms and rest on spheres are what
    // rods are for.
    if (GetParam().number > 26 ||
        std::ranges::count(std::vector<std::uint32_t>{3, 10, 14, 17, 26}, GetParam().number) > 0) {
        EXPECT_FALSE(result.claimed);
        return;
    }
    EXPECT_TRUE(result.claimed) << result.limit;
    EXPECT_TRUE(result.pass) << describe(result);
    EXPECT_FALSE(result.thresholds.empty());
    EXPECT_EQ(result.substeps, runtime::springSettings().substeps);
}

/// The settings that a game gets without choosing any.
TEST_P(HardCaseTest, RodsHoldWithTwoSubsteps) {
    const StabilityResult result = runHardCase(GetParam(), kRods, quick());
    if (GetParam().number == 5) {
        // Not claimed; nothing is lost, and the hair comes to rest, even so.
        EXPECT_FALSE(result.claimed);
        for (const StabilityThreshold& m : result.thresholds)
            EXPECT_TRUE(m.met() || m.what == "penetration") << describe(result);
        return;
    }
    EXPECT_TRUE(result.claimed) << result.limit;
    EXPECT_TRUE(result.pass) << describe(result);
    EXPECT_EQ(result.substeps, 2u);
}

INSTANTIATE_TEST_SUITE_P(Stability, HardCaseTest, testing::ValuesIn(hardCases().begin(), hardCases().end()),
                         [](const auto& tested) { return "Case" + std::to_string(tested.param.number); });

TEST(HardCaseLimits, UnclaimedCasesReportReasonAndLimit) {
    // Explicit Euler at a million times the stiffness; the leapfrog with segments of 0.1 mm.
    const StabilityResult stiff =
        runHardCase(hardCases()[8], springsWith(Integrator::explicitEuler), quick());
    EXPECT_FALSE(stiff.claimed);
    EXPECT_FALSE(stiff.pass);
    EXPECT_THAT(stiff.limit, HasSubstr("explicitEuler is unstable"));
    const StabilityResult tiny = runHardCase(hardCases()[11], springsWith(Integrator::leapfrog), quick());
    EXPECT_FALSE(tiny.claimed);
    EXPECT_TRUE(tiny.failedAt.has_value());
    EXPECT_THAT(verdict(tiny), HasSubstr("limit, at substep"));
}

/// What is promised is kept: a case that fails has its reason in theory, or at the thresholds of energy and
/// rest that the integrator does not claim.
TEST(HardCaseLimits, EveryIntegratorMeetsItsClaims) {
    StabilityOptions options = quick();
    options.stepsAtRest = 10'000;
    options.freeSeconds = 15.0;
    for (const StabilityResult& r : runHardCases(allStabilityMethods(), options)) {
        EXPECT_EQ(r.claimed, r.limit.empty()) << r.number << " " << r.integrator;
        EXPECT_TRUE(r.pass || !r.claimed) << r.number << " " << r.integrator << ": " << describe(r);
    }
}

TEST(HardCaseLimits, RestIsClaimedForPositionVerletAlone) {
    const auto claims = [](Integrator integrator) {
        const StabilityResult r = runHardCase(hardCases()[14], springsWith(integrator), quick());
        const auto rest = std::ranges::find(r.thresholds, "time to rest", &StabilityThreshold::what);
        const auto stretch = std::ranges::find(r.thresholds, "stretch", &StabilityThreshold::what);
        return std::pair(rest->claimed, stretch->claimed);
    };
    EXPECT_EQ(claims(Integrator::verlet), std::pair(true, true));
    EXPECT_EQ(claims(Integrator::rk4), std::pair(false, true));
}

struct BorderCase {
    Integrator integrator;
    MappedForce force;
};

void PrintTo(const BorderCase& printed, std::ostream* out) {
    *out << nameOf(printed.integrator) << " " << forceName(printed.force);
}

class Border : public testing::TestWithParam<BorderCase> {};

/// On both sides of ω h = 2 and 2√2, for soft and stiff springs.
TEST_P(Border, MatchesTheory) {
    const auto [integrator, force] = GetParam();
    const double limit = integrator == Integrator::rk4 ? 2.0 * std::numbers::sqrt2 : 2.0;
    ASSERT_DOUBLE_EQ(theoreticalLimit(integrator, force), limit);
    for (const double stiffness :
         force == MappedForce::coils ? std::vector{50.0, 800.0} : std::vector{0.05, 0.9}) {
        const double omega = fastestWave(integrator, force, stiffness);
        const StabilityProbe inside = probeStability(integrator, force, 0.95 * limit / omega, stiffness);
        const StabilityProbe outside = probeStability(integrator, force, 1.05 * limit / omega, stiffness);
        EXPECT_TRUE(inside.stable) << stiffness;
        EXPECT_FALSE(outside.stable) << stiffness;
        // And so says the advice before a run.
        EXPECT_NEAR(inside.adviceFactor, 0.95, 1e-3) << stiffness;
        EXPECT_NEAR(outside.adviceFactor, 1.05, 1e-3) << stiffness;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Measured, Border,
    testing::Values(BorderCase{Integrator::verlet, MappedForce::coils},
                    BorderCase{Integrator::velocityVerlet, MappedForce::coils},
                    BorderCase{Integrator::velocityVerlet, MappedForce::angular},
                    BorderCase{Integrator::leapfrog, MappedForce::coils},
                    BorderCase{Integrator::leapfrog, MappedForce::angular},
                    BorderCase{Integrator::rk4, MappedForce::coils},
                    BorderCase{Integrator::rk4, MappedForce::angular}),
    [](const auto& tested) {
        return std::string(nameOf(tested.param.integrator)).append(forceName(tested.param.force));
    });

TEST(StabilityMaps, ExplicitEulerAmplifiesAtAnyStep) {
    constexpr std::uint32_t kSteps = 8000;
    const double omega = fastestWave(Integrator::explicitEuler, MappedForce::coils, 100.0);
    for (const double wave : {0.1, 0.3, 1.0}) {
        EXPECT_FALSE(
            probeStability(Integrator::explicitEuler, MappedForce::coils, wave / omega, 100.0, kSteps)
                .stable);
    }
    // Too slowly to be seen in this time.
    EXPECT_TRUE(
        probeStability(Integrator::explicitEuler, MappedForce::coils, 0.005 / omega, 100.0, kSteps).stable);
}

TEST(StabilityMaps, WhatIsSolvedImplicitlyHasNoLimit) {
    for (const double h : {1e-4, 1e-2}) {
        EXPECT_TRUE(probeStability(Integrator::implicitEuler, MappedForce::coils, h, 2000.0).stable);
        EXPECT_TRUE(probeStability(Integrator::implicitEuler, MappedForce::angular, h, 0.99).stable);
        const StabilityProbe probe = probeStability(Integrator::verlet, MappedForce::angular, h, 0.99);
        EXPECT_TRUE(probe.stable);
        EXPECT_EQ(probe.adviceFactor, 0.0);
    }
}

TEST(StabilityMaps, AgreeWithTheoryAndAreDrawn) {
    const StabilityMap map = mapStability(Integrator::velocityVerlet, MappedForce::coils, 8, 1000);
    EXPECT_EQ(map.probes.size(), 64u);
    EXPECT_EQ(map.surprises, 0u);
    EXPECT_GT(std::ranges::count_if(map.probes, &StabilityProbe::stable), 10);
    EXPECT_LT(std::ranges::count_if(map.probes, &StabilityProbe::stable), 54);
    const std::string drawing = svg(stabilityPlot(map));
    EXPECT_TRUE(test::parseXml(drawing).has_value());
    EXPECT_THAT(drawing, HasSubstr("velocityVerlet"));
    EXPECT_THAT(drawing, HasSubstr("theory"));
}

TEST(StabilityReports, NameTheDecidingThreshold) {
    StabilityResult r;
    r.number = 4;
    r.name = "a \"case\", quoted";
    r.integrator = "verlet";
    r.substeps = 8;
    r.thresholds = {{"stretch", "%", 0.5, 1.0},
                    {"penetration", "mm", 0.7, 0.5},
                    {"points or strands lost", "", 0.0, 0.0}};
    r.pass = false;
    EXPECT_EQ(decidingThreshold(r), "penetration 0.7 of 0.5 mm");
    EXPECT_EQ(verdict(r), "FAIL");
    EXPECT_THAT(stabilityCsv({r}),
                HasSubstr("4,\"a \"\"case\"\", quoted\",,verlet,8,1,0,penetration,0.7,0.5,mm,,"));
    EXPECT_THAT(stabilityMarkdown({r}), HasSubstr("| FAIL: penetration 0.7 of 0.5 mm |"));
    r.thresholds[1].worst = std::nan("");
    EXPECT_FALSE(r.thresholds[1].met());
    EXPECT_EQ(r.closest().what, "penetration");
}

}  // namespace
}  // namespace hairloom
