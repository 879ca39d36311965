// SPDX-License-Identifier: GPL-3.0-or-later
// What a budget buys. Times are this machine's, so the tests choose budgets that are far above or below them.
#include "core/accuracy/budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/accuracy/hair.h"

namespace hairloom::test {
namespace {

using testing::Contains;
using testing::Field;

BudgetOptions few(double milliseconds) {
    BudgetOptions options;
    options.milliseconds = milliseconds;
    options.time.frames = 6;
    // Enough that a substep less is a good deal faster: a hiccup must not decide which setting is the slower
    // one.
    options.strands = 64;
    options.repeats = 15;
    return options;
}

Groom scene() {
    Groom groom = straightHair(64, 16);
    groom.simulation.windSpeed = 3;
    groom.simulation.substeps = 4;
    return groom;
}

Result<Budget> solve(const Groom& groom, double milliseconds) {
    const auto motion = makeRigidMotion("spin", groom);
    return solveBudget(groom, **motion, few(milliseconds), EngineConverged(8));
}

TEST(Budget, LargeBudgetExceedsAuthoredAccuracy) {
    const auto budget = solve(scene(), 1e5);
    ASSERT_TRUE(budget) << budget.error().message();
    EXPECT_TRUE(budget->fits);
    EXPECT_TRUE(budget->givenUp.empty());
    EXPECT_GT(budget->groom.simulation.substeps, 4u);
    EXPECT_EQ(budget->groom.pointCount(), 64u * 16u);
    EXPECT_GT(budget->authoredMilliseconds.median, 0);
}

TEST(Budget, ZeroBudgetTurnsOffAllOptionalEffects) {
    const auto budget = solve(scene(), 1e-6);
    ASSERT_TRUE(budget) << budget.error().message();
    EXPECT_FALSE(budget->fits);
    EXPECT_EQ(budget->groom.simulation.substeps, 1u);
    EXPECT_THAT(budget->givenUp, Contains(Field(&GivenUp::what, "substeps")));
    EXPECT_GT(budget->errorMm, 0);
    // What stays in any case.
    EXPECT_GE(budget->groom.simulation.lengthIterations, 1u);
    EXPECT_NE(budget->groom.simulation.gravity.y, 0.0f);
}

TEST(Budget, TheCheapestWithinAnErrorIsFound) {
    const Groom groom = scene();
    const auto motion = makeRigidMotion("spin", groom);
    BudgetOptions options = few(1);
    options.milliseconds.reset();
    options.withinMm = 1e4;
    const auto loose = solveBudget(groom, **motion, options, EngineConverged(64));
    ASSERT_TRUE(loose) << loose.error().message();
    EXPECT_TRUE(loose->fits);
    EXPECT_TRUE(loose->givenUp.size() > 0) << "anything is exact enough";
    // More substeps than any that is tried: none of them is the truth itself.
    options.withinMm = 1e-9;
    const auto strict = solveBudget(groom, **motion, options, EngineConverged(64));
    ASSERT_TRUE(strict) << strict.error().message();
    EXPECT_FALSE(strict->fits);
    EXPECT_LT(strict->errorMm, loose->errorMm) << "the most exact there is";
}

TEST(Budget, FramesThatAreTimedElsewhereLoseFollowHairsFirst) {
    Groom groom = scene();
    groom.interpolation.followPerGuide = 40;
    const auto motion = makeRigidMotion("none", groom);
    BudgetOptions options = few(1.1);
    options.frameTime = [](const Groom& timed) -> Result<double> {
        return 0.1 * timed.interpolation.followPerGuide;
    };
    const auto budget = solveBudget(groom, **motion, options, EngineConverged(8));
    ASSERT_TRUE(budget) << budget.error().message();
    EXPECT_TRUE(budget->fits);
    EXPECT_EQ(budget->groom.interpolation.followPerGuide, 10u);
    EXPECT_TRUE(budget->groom.simulation.windSpeed > 0) << "effects stay";
    EXPECT_FALSE(budget->busy());
    EXPECT_DOUBLE_EQ(budget->milliseconds.median, 1);
}

TEST(Budget, TimesThatDifferTooMuchAreOfABusyMachine) {
    const Groom groom = scene();
    const auto motion = makeRigidMotion("none", groom);
    BudgetOptions options = few(100);
    int calls = 0;
    options.frameTime = [&](const Groom&) -> Result<double> { return ++calls % 2 ? 1.0 : 2.0; };
    const auto spread = solveBudget(groom, **motion, options, EngineConverged(8));
    ASSERT_TRUE(spread) << spread.error().message();
    EXPECT_TRUE(spread->busy());
    // Steady in itself, and twice as slow with each look.
    calls = 0;
    options.frameTime = [&](const Groom&) -> Result<double> { return 1 << (calls++ / 16 % 8); };
    const auto drifts = solveBudget(groom, **motion, options, EngineConverged(8));
    ASSERT_TRUE(drifts) << drifts.error().message();
    EXPECT_TRUE(drifts->busy());
}

TEST(Budget, AccuracyGrowsWithTheBudget) {
    const auto poor = solve(scene(), 1e-6);
    const auto rich = solve(scene(), 1e5);
    ASSERT_TRUE(poor && rich);
    EXPECT_LE(rich->errorMm, poor->errorMm);
}

TEST(Budget, UnsupportedSettingsAreErrors) {
    const Groom none;
    const auto motion = makeRigidMotion("none", scene());
    EXPECT_FALSE(solveBudget(none, **motion, few(1), EngineConverged(8)));
}

}  // namespace
}  // namespace hairloom::test
