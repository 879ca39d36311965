// SPDX-License-Identifier: GPL-3.0-or-later
// What the benchmarks run on is what they say; how long it takes is not tested.
#include "core/cost/step_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/cost/instruction_set_limit.h"

namespace hairloom {
namespace {

using runtime::StageId;
using scenes::ActiveForces;

TEST(StepCost, WithAllEffectsOffRootsAndIntegratorAreLeft) {
    StepRun run(
        {.strands = 40, .activeForces = ActiveForces::nothing, .model = runtime::StrandModel::springs});
    run.milliseconds(2);
    const auto stages = run.engine().plan().stages();
    ASSERT_EQ(stages.size(), 2u);
    EXPECT_EQ(stages[0], StageId::roots);
    EXPECT_EQ(stages[1], StageId::verlet);
    EXPECT_EQ(run.work(), 40 * 16 * 8);
}

TEST(StepCost, HairTouchesTheSpheresInTheWind) {
    StepRun run({.strands = 200, .activeForces = ActiveForces::windAndSpheres});
    run.milliseconds(20);
    using runtime::Effect;
    for (const Effect effect : {Effect::wind, Effect::collision, Effect::angular, Effect::torsion,
                                Effect::length, Effect::gravity, Effect::damping})
        EXPECT_TRUE(run.engine().plan().on(effect)) << run.engine().plan().why(effect);
    const auto measured = run.engine().measure();
    EXPECT_EQ(measured.nanCount, 0u);
    EXPECT_EQ(measured.asleep, 0u);
}

TEST(StepCost, StagesAreThoseOfThePlanAndPartOfTheStep) {
    StepRun run({.strands = 100, .activeForces = ActiveForces::gravity, .byStage = true});
    for (int f = 0; f < 5; ++f) {
        const double step = run.milliseconds(1);
        const auto& stages = run.stageMilliseconds();
        EXPECT_LE(std::accumulate(stages.begin(), stages.end(), 0.0), step);
        const auto planned = run.engine().plan().stages();
        for (std::uint32_t i = 0; i < runtime::kStageCount; ++i) {
            const auto id = static_cast<StageId>(i);
            EXPECT_EQ(stages[i] > 0.0, std::ranges::count(planned, id) > 0) << runtime::stageName(id);
        }
    }
}

TEST(StepCost, StrandsHaveTheirLengthAndShapeWithAnyNumberOfPoints) {
    for (const std::uint32_t points : {16u, 24u, 31u}) {
        const scenes::HeadOfHair head(50, points);
        ASSERT_EQ(head.strandCount(), 50u);
        ASSERT_EQ(head.positions.size(), std::size_t{50} * points);
        ASSERT_EQ(head.spheres.size(), 10u);
        const scenes::HeadOfHair usual(50, 16);
        for (std::uint32_t s = 0; s < 50; ++s) {
            double total = 0.0;
            for (std::uint32_t p = head.offsets[s]; p + 1 < head.offsets[s + 1]; ++p)
                total += static_cast<double>(length(head.positions[p + 1] - head.positions[p]));
            EXPECT_NEAR(total, 0.3, 1e-5);
            const auto tip = head.positions[head.offsets[s + 1] - 1];
            EXPECT_LT(length(tip - usual.positions[usual.offsets[s + 1] - 1]), 0.03f) << points;
        }
    }
}

TEST(StepCost, AnInstructionSetIsHeldAndLetGo) {
    const std::string best = runtime::Engine::instructionSet();
    const auto available = InstructionSetLimit::available();
    ASSERT_FALSE(available.empty());
    {
        const InstructionSetLimit limit(available.front());
        EXPECT_EQ(runtime::Engine::instructionSet(), best) << "the best comes first";
    }
    if (available.size() > 1) {
        const InstructionSetLimit limit(available.back());
        EXPECT_NE(runtime::Engine::instructionSet(), best);
    }
    EXPECT_EQ(runtime::Engine::instructionSet(), best);
}

}  // namespace
}  // namespace hairloom
