// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that stays in its place falls asleep on the device as on the CPU, though it is not slow.

#include "core/stability/strand_set.h"
#include "runtime/engine/state.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::kBlockLanes;
using runtime::Rest;

struct StayCase {
    runtime::StrandModel model;
    LayoutOptions layout;
};

void PrintTo(const StayCase& which, std::ostream* out) {
    *out << (which.model == runtime::StrandModel::rods ? "rods " : "springs ") << nameOf(which.layout);
}

std::vector<StayCase> stayCases() {
    std::vector<StayCase> cases;
    for (const LayoutOptions& layout : kHeldLayouts) cases.push_back({runtime::StrandModel::springs, layout});
    for (const LayoutOptions& layout : kRodLayouts) cases.push_back({runtime::StrandModel::rods, layout});
    return cases;
}

class Staying : public GpuSimulationTest, public testing::WithParamInterface<StayCase> {};

TEST_P(Staying, FallsAsleepWhereNoAnchorIsLeft) {
    constexpr float kFrame = 1.0f / 60.0f;
    StrandSet strands;
    for (int s = 0; s < 96; ++s)
        strands.add({0.0f, 0.1f, 0.001f * static_cast<float>(s)}, {0.0f, -1.0f, 0.0f}, 0.02f, 8);
    runtime::SimulationSettings s = runtime::springSettings();
    s.strandModel = GetParam().model;
    // Nothing is slow for ten seconds. Anchors reach 0.1 mm.
    s.sleepSpeed = 1e-5f;
    s.sleepDelay = 10.0f;
    StrandEngine engine = engineOf(strands.view(), s, options(GetParam().layout));
    const std::vector<runtime::RootFrame> roots = strands.roots();
    const auto frame = [&] { ASSERT_TRUE(engine.step({kFrame, 0.0, roots, {}})); };
    // Anchors go to where hair hangs as soon as it is known to be elsewhere.
    frame();
    frame();
    auto state = engine.readState();
    ASSERT_TRUE(state);
    ASSERT_EQ(state->rests.size(), 3u);
    for (const Rest& rest : state->rests) {
        EXPECT_FLOAT_EQ(rest.stayed, kFrame);
        EXPECT_NEAR(rest.anchors[(3 * (Rest::kAnchors - 1) + 1) * kBlockLanes], -0.14f, 5e-4f);
    }
    for (Rest& rest : state->rests) rest.stayed = 50.0f;
    // The second block's strand 7 has its tip's anchor 1 mm away.
    float& away = state->rests[1].anchors[3 * (Rest::kAnchors - 1) * kBlockLanes + 7];
    const float there = away;
    away += 1e-3f;
    ASSERT_TRUE(engine.writeState(*state));
    frame();
    EXPECT_EQ(engine.report()->asleep, 64u);
    state = engine.readState();
    ASSERT_TRUE(state);
    EXPECT_TRUE(state->rests[0].asleep && !state->rests[1].asleep && state->rests[2].asleep);
    EXPECT_EQ(state->rests[1].stayed, 0.0f);
    frame();
    EXPECT_EQ(engine.report()->asleep, 64u);
    state = engine.readState();
    ASSERT_TRUE(state);
    EXPECT_FLOAT_EQ(state->rests[1].stayed, kFrame);
    EXPECT_NEAR(state->rests[1].anchors[3 * (Rest::kAnchors - 1) * kBlockLanes + 7], there, 1e-4f);
    // What woke has to stay as long again.
    std::vector<runtime::RootFrame> moved = roots;
    moved[3].position.y += 1e-5f;
    ASSERT_TRUE(engine.step({kFrame, 0.0, moved, {}}));
    EXPECT_EQ(engine.report()->asleep, 32u);
    ASSERT_TRUE(engine.step({kFrame, 0.0, moved, {}}));
    EXPECT_EQ(engine.report()->asleep, 32u);
}

INSTANTIATE_TEST_SUITE_P(Layouts, Staying, testing::ValuesIn(stayCases()));

}  // namespace
}  // namespace hairloom::gpu_simulation
