// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/plan.h"

#include <gmock/gmock.h>

#include "hairloom/presets.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

using testing::ElementsAre;

PlanInput sceneOf(const SimulationSettings& settings) {
    PlanInput scene;
    scene.settings = settings;
    scene.strandCount = 10;
    scene.longestPointCount = 16;
    scene.longestStrand = 0.3f;
    scene.rootsMin_ws = {-0.1f, 0.0f, -0.1f};
    scene.rootsMax_ws = {0.1f, 0.1f, 0.1f};
    return scene;
}

TEST(Plan, DefaultSceneSaysWhatRunsAndWhy) {
    const EffectPlan p = plan(sceneOf(springSettings()));
    EXPECT_THAT(p.stages(),
                ElementsAre(StageId::roots, StageId::damping, StageId::drag, StageId::gravity,
                            StageId::verlet, StageId::angular, StageId::length, StageId::extension));
    EXPECT_EQ(p.why(Effect::gravity), "gravity: on, 9.81 m/s²");
    EXPECT_EQ(p.why(Effect::wind), "wind: off, zero speed");
    EXPECT_EQ(p.why(Effect::angular), "angular: on, stiffness 0.3");
    EXPECT_EQ(p.why(Effect::collision), "collision: off, no spheres");
}

TEST(Plan, WithoutEffectsOnlyTheIntegratorRuns) {
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    const EffectPlan p = plan(sceneOf(s));
    EXPECT_THAT(p.stages(), ElementsAre(StageId::roots, StageId::verlet));
    EXPECT_EQ(p.why(Effect::gravity), "gravity: off, zero gravity");
    EXPECT_EQ(p.why(Effect::angular), "angular: off, zero stiffness");
    EXPECT_EQ(p.why(Effect::length), "length: off, zero iterations");
}

TEST(Plan, WindReplacesStillAir) {
    SimulationSettings s = springSettings();
    s.windSpeed = 3.0f;
    const EffectPlan p = plan(sceneOf(s));
    EXPECT_THAT(p.stages(),
                ElementsAre(StageId::roots, StageId::damping, StageId::wind, StageId::gravity,
                            StageId::verlet, StageId::angular, StageId::length, StageId::extension));
    EXPECT_EQ(p.why(Effect::wind), "wind: on, 3 m/s");
    EXPECT_EQ(p.why(Effect::drag), "drag: off, part of the wind");
    s.airDrag = 0.0f;
    EXPECT_EQ(plan(sceneOf(s)).why(Effect::wind), "wind: off, air drag is zero, so hair does not feel air");
}

TEST(Plan, SpheresCountOnlyWithinReach) {
    PlanInput scene = sceneOf(springSettings());
    const std::vector<Sphere> spheres{{{0.0f, -0.5f, 0.0f}, 0.25f}, {{5.0f, 0.0f, 0.0f}, 0.25f}};
    scene.spheres = std::span(spheres).first(1);
    EXPECT_EQ(plan(scene).why(Effect::collision), "collision: on, 1 sphere within reach");
    scene.spheres = std::span(spheres).last(1);
    EXPECT_EQ(plan(scene).why(Effect::collision), "collision: off, no sphere within reach of a strand");
    const std::vector<Float3> motion{{10.0f, 0.0f, 0.0f}};
    scene.sphereMotion = motion;
    EXPECT_TRUE(plan(scene).on(Effect::collision)) << "it passed through the hair on its way";
}

TEST(Plan, ARigidStrandOnlyMovesItsRoots) {
    PlanInput scene = sceneOf(springSettings());
    scene.longestPointCount = 2;
    EXPECT_THAT(plan(scene).stages(), ElementsAre(StageId::roots));
    EXPECT_EQ(plan(scene).why(Effect::gravity), "gravity: off, no point of any strand is free");
}

TEST(Plan, DisabledEffectsHaveNoMemory) {
    const Strands strands = tuft(40);
    Engine engine = makeEngine(strands, bare());
    run(engine, strands, 2);
    for (std::uint32_t e = 0; e < kEffectCount; ++e)
        EXPECT_EQ(engine.effectBytes(static_cast<Effect>(e)), 0u) << e;
    SimulationSettings s = bare();
    s.angularStiffness = 0.5f;
    EXPECT_EQ(engine.setSettings(s), "");
    EXPECT_GE(engine.effectBytes(Effect::angular), 40u * 12u * sizeof(float));
    EXPECT_EQ(engine.setSettings(bare()), "");
    EXPECT_EQ(engine.effectBytes(Effect::angular), 0u);
}

}  // namespace
}  // namespace hairloom::runtime
