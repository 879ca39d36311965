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
    options.strands = 4;
    // Frames of so few strands are short: a hiccup must not decide which setting is the slower one.
    options.repeats = 15;
    return options;
}

Groom scene() {
    Groom groom = straightHair(8, 16);
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
    EXPECT_EQ(budget->groom.pointCount(), 8u * 16u);
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
