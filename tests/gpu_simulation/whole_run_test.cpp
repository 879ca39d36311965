// SPDX-License-Identifier: GPL-3.0-or-later
// Whole runs: beside the engine on the CPU, beside the reference in double precision, and what only shows
// over many frames.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/cost/benchmark_scenes.h"
#include "core/simulation/reference/solver.h"
#include "core/stability/strand_set.h"
#include "hairloom/engine.h"
#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;
using runtime::Measurements;
using runtime::RootFrame;
using runtime::SimulationSettings;
using runtime::springSettings;

constexpr float kFrame = 1.0f / 60.0f;

class WholeRun : public GpuSimulationTest {
  protected:
    static std::vector<Float3> positionsOf(StrandEngine& engine) {
        std::vector<Float3> positions(engine.pointCount());
        EXPECT_TRUE(engine.readPositions(positions));
        return positions;
    }
    static double farthest(std::span<const Float3> a, std::span<const Float3> b) {
        double maximum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            maximum = std::max(maximum, static_cast<double>(length(a[i] - b[i])));
        return maximum;
    }
    static double meanDistance(std::span<const Float3> a, std::span<const Float3> b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(length(a[i] - b[i]));
        return sum / static_cast<double>(a.size());
    }
};

class EachLayout : public WholeRun, public testing::WithParamInterface<LayoutOptions> {};
INSTANTIATE_TEST_SUITE_P(Layouts, EachLayout, testing::ValuesIn(kHeldLayouts),
                         [](const auto& instance) { return nameOf(instance.param); });

/// Every effect on a head of hair that turns. Contacts amplify rounding, so that single points part; the hair
/// as a whole does not, and no bound is broken.
TEST_P(EachLayout, EveryEffectStaysWithTheCpu) {
    const scenes::HeadOfHair head(64, 16);
    const SimulationSettings settings =
        scenes::settingsFor(scenes::ActiveForces::windAndSpheres, runtime::StrandModel::springs);
    StrandEngine gpu = engineOf(head.view(), settings, options(GetParam()));
    runtime::Engine cpu = *runtime::Engine::make(head.view(), settings).engine;
    std::vector<RootFrame> roots;
    head.placeRoots(0.0, roots);
    ASSERT_TRUE(gpu.reset(roots));
    cpu.reset(roots);
    std::vector<Float3> onCpu(cpu.pointCount());
    double energyGpu = 0.0, energyCpu = 0.0;
    for (int f = 1; f <= 45; ++f) {
        const double time = f * static_cast<double>(kFrame);
        head.placeRoots(time, roots);
        const runtime::FrameInput input{kFrame, time, roots, head.spheres};
        ASSERT_TRUE(gpu.step(input));
        cpu.step(input);
        const Measurements measured = gpu.measure().value(), other = cpu.measure();
        EXPECT_EQ(measured.nanCount, 0u);
        EXPECT_LE(measured.maxStretch, static_cast<double>(settings.maximalExtension) + 1e-4);
        EXPECT_LE(measured.maxPenetration, std::max(other.maxPenetration, 0.0) + 5e-4);
        energyGpu += measured.kineticEnergy;
        energyCpu += other.kineticEnergy;
        if (f != 5) continue;
        cpu.readPositions(onCpu);
        EXPECT_LE(farthest(positionsOf(gpu), onCpu), 1e-3);
    }
    cpu.readPositions(onCpu);
    EXPECT_LE(meanDistance(positionsOf(gpu), onCpu), 2e-3);
    EXPECT_NEAR(energyGpu, energyCpu, 0.05 * energyCpu);
}

/// Poses inside a frame come to the bits of the frames that they stand for, and a cut takes the hair along.
TEST_F(WholeRun, AFrameOfQuartersIsItsFourQuarterFrames) {
    const scenes::HeadOfHair head(16, 16);
    for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
        SimulationSettings settings = scenes::settingsFor(scenes::ActiveForces::windAndSpheres, model);
        settings.substeps = 2;
        StrandEngine whole = engineOf(head.view(), settings, options());
        StrandEngine quarters = engineOf(head.view(), settings, options());
        std::vector<RootFrame> roots;
        head.placeRoots(0.0, roots);
        ASSERT_TRUE(whole.reset(roots));
        ASSERT_TRUE(quarters.reset(roots));
        constexpr float kSlow = 1.0f / 30.0f;
        for (int f = 1; f <= 8; ++f) {
            const double time = f * static_cast<double>(kSlow);
            std::array<std::vector<RootFrame>, 4> poses;
            std::vector<runtime::InnerPose> inner;
            for (std::size_t q = 0; q < 4; ++q) {
                const double at = time - static_cast<double>(kSlow) * static_cast<double>(3 - q) / 4.0;
                head.placeRoots(at, poses[q]);
                runtime::FrameInput part{kSlow / 4.0f, at, poses[q], head.spheres};
                part.cut = f == 5 && q == 0;
                ASSERT_TRUE(quarters.step(part));
                if (q < 3) inner.push_back({poses[q], head.spheres});
            }
            runtime::FrameInput input{kSlow, time, poses[3], head.spheres};
            input.inner = inner;
            input.cut = f == 5;
            ASSERT_TRUE(whole.step(input));
            ASSERT_EQ(whole.stateHash().value(), quarters.stateHash().value()) << f;
        }
        // Half a metre farther on in one frame.
        const std::vector<Float3> before = positionsOf(whole);
        head.placeRoots(8.0 * static_cast<double>(kSlow), roots);
        for (RootFrame& root : roots) root.position.x += 0.5f;
        runtime::FrameInput jump{1e-4f, 8.0 * static_cast<double>(kSlow), roots, {}};
        jump.cut = true;
        ASSERT_TRUE(whole.step(jump));
        std::vector<Float3> there = before;
        for (Float3& at : there) at.x += 0.5f;
        EXPECT_LT(farthest(positionsOf(whole), there), 2e-3) << "what it moves by itself in 0.1 ms";
    }
}

/// Backward Euler of a turning head in wind.
SimulationSettings backwardEuler(runtime::LengthMethod lengths) {
    SimulationSettings s =
        scenes::settingsFor(scenes::ActiveForces::windAndSpheres, runtime::StrandModel::springs);
    s.integrator = runtime::Integrator::implicitEuler;
    s.angularMethod = runtime::AngularMethod::smallAngle;
    s.lengthMethod = lengths;
    s.substeps = 4;
    return s;
}

/// Coil springs of 40 million N/m at a mass of 1 kg, and nothing else to hold them: they stay as long as the
/// CPU's, and where the CPU's are.
TEST_P(EachLayout, BackwardEulerHoldsStiffSprings) {
    const scenes::HeadOfHair head(64, 16);
    SimulationSettings settings = backwardEuler(runtime::LengthMethod::springs);
    settings.springFrequency = 1'000.0f;
    settings.lengthIterations = 0;
    StrandEngine gpu = engineOf(head.view(), settings, options(GetParam()));
    runtime::Engine cpu = *runtime::Engine::make(head.view(), settings).engine;
    std::vector<RootFrame> roots;
    head.placeRoots(0.0, roots);
    ASSERT_TRUE(gpu.reset(roots));
    cpu.reset(roots);
    std::vector<Float3> onCpu(cpu.pointCount());
    for (int f = 1; f <= 60; ++f) {
        const double time = f * static_cast<double>(kFrame);
        head.placeRoots(time, roots);
        const runtime::FrameInput input{kFrame, time, roots, head.spheres};
        ASSERT_TRUE(gpu.step(input));
        cpu.step(input);
        const Measurements measured = gpu.measure().value(), other = cpu.measure();
        EXPECT_EQ(measured.nanCount, 0u);
        EXPECT_LE(measured.maxStretch, 1.5 * other.maxStretch + 0.001) << f;
        cpu.readPositions(onCpu);
        if (f == 5) {
            EXPECT_LE(farthest(positionsOf(gpu), onCpu), 1e-3);
        }
    }
    EXPECT_LE(meanDistance(positionsOf(gpu), onCpu), 2e-3);
}

/// Long strands have their system in a buffer. (The layouts of kHeldLayouts are compared above.)
TEST_F(WholeRun, BackwardEulerIsTheSameInBuffersAndGroups) {
    const scenes::HeadOfHair head(40, 8);
    SimulationSettings settings =
        scenes::settingsFor(scenes::ActiveForces::gravity, runtime::StrandModel::springs);
    settings.integrator = runtime::Integrator::implicitEuler;
    settings.lengthMethod = runtime::LengthMethod::springs;
    settings.substeps = 1;
    std::vector<Float3> first;
    for (const StrandStorage storage :
         {StrandStorage::threads, StrandStorage::groups, StrandStorage::buffers}) {
        EngineOptions options;
        options.layout = {storage, false};
        StrandEngine engine = engineOf(head.view(), settings, options);
        std::vector<RootFrame> roots;
        for (int f = 1; f <= 6; ++f) {
            const double time = f * static_cast<double>(kFrame);
            head.placeRoots(time, roots);
            ASSERT_TRUE(engine.step({kFrame, time, roots, {}}));
        }
        const std::vector<Float3> positions = positionsOf(engine);
        for (const Float3& p : positions)
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        if (first.empty()) first = positions;
        // Compilers of devices fuse the products of each layout in their own way: 0.03 mm apart on an H200.
        EXPECT_LE(farthest(positions, first), 1e-4) << nameOf(options.layout);
    }
}

/// Its first step from rest is ½ a h², so that free points fall as the closed form says.
TEST_P(EachLayout, VerletStartsAtTheHalfStep) {
    const scenes::HeadOfHair head(4, 8);
    SimulationSettings settings = springSettings();
    settings.lengthIterations = 0;
    settings.angularStiffness = settings.airDrag = settings.dampingTime = 0.0f;
    settings.substeps = 2;
    StrandEngine gpu = engineOf(head.view(), settings, options(GetParam()));
    std::vector<RootFrame> roots;
    head.placeRoots(0.0, roots);
    ASSERT_TRUE(gpu.reset(roots));
    const std::vector<Float3> before = positionsOf(gpu);
    for (int f = 1; f <= 6; ++f) ASSERT_TRUE(gpu.step({kFrame, f * static_cast<double>(kFrame), roots, {}}));
    const std::vector<Float3> after = positionsOf(gpu);
    for (std::size_t p = 2; p < 8; ++p)
        EXPECT_NEAR(before[p].y - after[p].y, 0.5f * 9.81f * 0.01f, 1e-5f) << p;
}

/// Where a strand is kept between substeps, and whether loops are unrolled, is nothing that the hair notices.
TEST_F(WholeRun, LayoutsAgree) {
    const scenes::HeadOfHair head(40, 8);
    const SimulationSettings settings =
        scenes::settingsFor(scenes::ActiveForces::windAndSpheres, runtime::StrandModel::springs);
    std::vector<Float3> first;
    for (const LayoutOptions layout :
         {LayoutOptions{StrandStorage::threads, false}, LayoutOptions{StrandStorage::threads, true},
          LayoutOptions{StrandStorage::groups, false}, LayoutOptions{StrandStorage::buffers, false},
          LayoutOptions{StrandStorage::lanes, false, 4, 1}, LayoutOptions{StrandStorage::lanes, false, 2, 2},
          LayoutOptions{StrandStorage::wisps, false}}) {
        EngineOptions options;
        options.layout = layout;
        options.velocities = layout.unroll;
        StrandEngine engine = engineOf(head.view(), settings, options);
        std::vector<RootFrame> roots;
        for (int f = 1; f <= 6; ++f) {
            const double time = f * static_cast<double>(kFrame);
            head.placeRoots(time, roots);
            ASSERT_TRUE(engine.step({kFrame, time, roots, head.spheres}));
        }
        const std::vector<Float3> positions = positionsOf(engine);
        if (first.empty()) first = positions;
        EXPECT_LE(farthest(positions, first), 1e-5);
        if (!options.velocities) continue;
        std::vector<Float3> velocities(engine.pointCount());
        ASSERT_TRUE(engine.readVelocities(velocities));
        std::vector<shaders::float4> written(engine.pointCount());
        ASSERT_TRUE(
            device()->readBuffer(engine.velocities_ws(), 0, std::as_writable_bytes(std::span(written))));
        for (std::size_t p = 0; p < velocities.size(); ++p) EXPECT_NEAR(written[p].x, velocities[p].x, 1e-4);
    }
}

/// Strands of 2 to 70 points, and substeps whose length changes.
TEST_F(WholeRun, ManyPointCountsAndFrameTimes) {
    test::Scene scene;
    test::Dice dice(3);
    constexpr std::uint32_t kPoints[] = {2, 3, 5, 70};
    test::addStrands(scene, test::Hair::curled, 70, kPoints, dice);
    SimulationSettings settings = springSettings();
    settings.substeps = 2;
    // Uneven segments: bending and lengths are solved as one system, which multiplies what rounding makes of
    // lengths by 2,000 and more.
    settings.angularStiffness = 0.3f;
    StrandEngine gpu = engineOf(scene.view(), settings, options());
    runtime::Engine cpu = *runtime::Engine::make(scene.view(), settings).engine;
    std::vector<RootFrame> roots;
    for (std::size_t s = 0; s + 1 < scene.offsets.size(); ++s)
        roots.push_back({scene.positions[scene.offsets[s]], {}});
    double time = 0.0;
    for (const float dt : {0.016f, 0.016f, 0.004f, 0.03f, 0.0f, 0.016f}) {
        time += static_cast<double>(dt);
        for (RootFrame& root : roots) root.position.x += 0.1f * dt;
        const runtime::FrameInput input{dt, time, roots};
        ASSERT_TRUE(gpu.step(input));
        cpu.step(input);
    }
    std::vector<Float3> onCpu(cpu.pointCount());
    cpu.readPositions(onCpu);
    EXPECT_LE(farthest(positionsOf(gpu), onCpu), 1e-3);
}

/// A hinged strand without damping swings as the double-precision reference says.
TEST_F(WholeRun, SwingsAsTheReferenceSays) {
    SimulationSettings s = springSettings();
    s.integrator = runtime::Integrator::rk4;
    s.substeps = 32;
    s.clampedPoints = 1;
    s.dampingTime = s.airDrag = s.angularStiffness = s.sleepSpeed = 0.0f;
    test::Scene scene;
    for (std::uint32_t p = 0; p < 6; ++p)
        scene.positions.push_back({0.03f * static_cast<float>(p), 0.0f, 0.0f});
    scene.offsets.push_back(6);
    StrandEngine gpu = engineOf(scene.view(), s, options());
    auto reference = reference::Solver::make(reference::strandsOf(scene.view()), s);
    ASSERT_TRUE(reference);
    const std::vector<RootFrame> roots{{{0.0f, 0.0f, 0.0f}, {}}};
    for (int f = 1; f <= 20; ++f) {
        const runtime::FrameInput input{kFrame, f * static_cast<double>(kFrame), roots};
        ASSERT_TRUE(gpu.step(input));
        reference->step(reference::frameOf(input));
    }
    const auto groundTruth = reference->positions_ws();
    const std::vector<Float3> positions = positionsOf(gpu);
    for (std::size_t p = 0; p < groundTruth.size(); ++p) {
        EXPECT_NEAR(static_cast<double>(positions[p].x), groundTruth[p].x(), 1e-4) << p;
        EXPECT_NEAR(static_cast<double>(positions[p].y), groundTruth[p].y(), 1e-4) << p;
    }
}

/// Hair at rest falls asleep and stays as it is; a sphere or a root that moves wakes it, and only near it.
TEST_P(EachLayout, SleepsAndWakes) {
    StrandSet strands;
    for (int s = 0; s < 64; ++s) {
        // Two blocks, a metre apart.
        const Float3 root{s < 32 ? 0.0f : 1.0f, 0.1f, 0.001f * static_cast<float>(s)};
        strands.add(root, {0.0f, -1.0f, 0.0f}, 0.02f, 8);
    }
    SimulationSettings s = springSettings();
    s.sleepDelay = 0.1f;
    StrandEngine engine = engineOf(strands.view(), s, options(GetParam()));
    std::vector<RootFrame> roots = strands.roots();
    std::vector<runtime::Sphere> spheres{{{0.0f, 0.0f, 0.0f}, 0.017f}};
    const auto frame = [&] { ASSERT_TRUE(engine.step({kFrame, 0.0, roots, spheres})); };
    for (int f = 0; f < 120; ++f) frame();
    EXPECT_EQ(engine.report()->asleep, 64u);
    const std::vector<Float3> before = positionsOf(engine);
    for (int f = 0; f < 10; ++f) frame();
    EXPECT_EQ(farthest(positionsOf(engine), before), 0.0);
    spheres[0].center_ws.x = 0.002f;
    frame();
    EXPECT_EQ(engine.report()->asleep, 32u);
    for (int f = 0; f < 120; ++f) frame();
    EXPECT_EQ(engine.report()->asleep, 64u);
    roots[40].position.y += 0.001f;
    frame();
    EXPECT_EQ(engine.report()->asleep, 32u);
    EXPECT_EQ(engine.measure()->asleep, 32u);
}
/// A cut carries strands along rigidly; what is no number goes back to rest and is counted, and roots,
/// spheres and winds that are none are left out.
TEST_P(EachLayout, TeleportsAndRestoredStrands) {
    StrandSet strands = tuft(6);
    SimulationSettings s = springSettings();
    s.gravity = {};
    s.restGravity = 0.0f;
    StrandEngine engine = engineOf(strands.view(), s, options(GetParam()));
    std::vector<RootFrame> roots = strands.roots();
    ASSERT_TRUE(engine.step({kFrame, 0.0, roots, {}}));
    const std::vector<Float3> before = positionsOf(engine);
    for (RootFrame& root : roots) root.position.x += 10.0f;
    ASSERT_TRUE(engine.step({kFrame, 0.0, roots, {}}));
    const std::vector<Float3> after = positionsOf(engine);
    for (std::size_t p = 0; p < before.size(); ++p) EXPECT_NEAR(after[p].x, before[p].x + 10.0f, 1e-5f);

    runtime::State state = engine.readState().value();
    state.planes[2 * runtime::kBlockLanes + 3] = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(engine.writeState(state));
    roots[1].position.y = std::numeric_limits<float>::infinity();
    const runtime::Sphere none{{std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}, 0.1f};
    runtime::FrameInput input{kFrame, 0.0, roots, {&none, 1}};
    input.wind_ws = Float3{std::numeric_limits<float>::infinity(), 0.0f, 0.0f};
    ASSERT_TRUE(engine.step(input));
    const FrameReport report = engine.report().value();
    EXPECT_EQ(report.restoredStrands, 1u);
    EXPECT_EQ(report.rejectedRoots, 1u);
    EXPECT_EQ(report.rejectedSpheres, 1u);
    EXPECT_EQ(report.rejectedWinds, 1u);
    EXPECT_EQ(engine.measure()->nanCount, 0u);
    const std::vector<Float3> restored = positionsOf(engine);
    EXPECT_LE(farthest(restored, after), 1e-4);
}
/// Equal input, equal bits; and a state that was read goes on as if nothing had been.
TEST_F(WholeRun, StatesCanBeTakenAndPutBack) {
    const scenes::HeadOfHair head(40, 5);
    const SimulationSettings settings =
        scenes::settingsFor(scenes::ActiveForces::windAndSpheres, runtime::StrandModel::springs);
    std::vector<RootFrame> roots;
    const auto run = [&](StrandEngine& engine, int first, int last) {
        for (int f = first; f <= last; ++f) {
            const double time = f * static_cast<double>(kFrame);
            head.placeRoots(time, roots);
            ASSERT_TRUE(engine.step({kFrame, time, roots, head.spheres}));
        }
    };
    StrandEngine a = engineOf(head.view(), settings, options()),
                 b = engineOf(head.view(), settings, options());
    run(a, 1, 8);
    run(b, 1, 4);
    const runtime::State middle = b.readState().value();
    run(b, 5, 8);
    EXPECT_EQ(a.stateHash().value(), b.stateHash().value());
    ASSERT_TRUE(b.writeState(middle));
    run(b, 5, 8);
    EXPECT_EQ(a.stateHash().value(), b.stateHash().value());
}

}  // namespace
}  // namespace hairloom::gpu_simulation
