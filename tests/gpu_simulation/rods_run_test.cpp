// SPDX-License-Identifier: GPL-3.0-or-later
// Whole runs of elastic rods on the device beside the engine on the CPU.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

#include "core/cost/benchmark_scenes.h"
#include "core/stability/strand_set.h"
#include "hairloom/capsules.h"
#include "hairloom/engine.h"
#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;
using runtime::Quat;
using runtime::RootFrame;
using runtime::SimulationSettings;

constexpr float kFrame = 1.0f / 60.0f;

SimulationSettings rods() {
    SimulationSettings s;
    s.strandModel = runtime::StrandModel::rods;
    s.substeps = 8;
    return s;
}

StrandSet manyPointCounts(std::initializer_list<std::uint32_t> counts) {
    StrandSet strands;
    test::Dice dice(3);
    for (const std::uint32_t points : counts) {
        std::vector<Float3> strand{dice.inside(0.1f)};
        Float3 direction = dice.inside(1.0f) + Float3{0.0f, -1.5f, 0.0f};
        const float segment = 0.25f / static_cast<float>(points - 1);
        // As curly whatever the number of points.
        const float bend = 4.0f * std::sqrt(segment);
        while (strand.size() < points) {
            direction = direction + dice.inside(bend);
            direction = direction * (1.0f / length(direction));
            strand.push_back(strand.back() + direction * segment);
        }
        strands.add(strand);
    }
    return strands;
}

/// A head of locks: helices of 6 mm about strands that hang.
StrandSet curls(std::uint32_t count, std::uint32_t points) {
    const scenes::HeadOfHair head(count, points);
    StrandSet strands;
    for (std::uint32_t s = 0; s < count; ++s) {
        std::vector<Float3> strand;
        const Float3 out = head.roots[s] * (1.0f / scenes::HeadOfHair::kHeadRadius);
        for (std::uint32_t p = 0; p < points; ++p) {
            const float along = static_cast<float>(p) / static_cast<float>(points - 1);
            const float turn = 10.0f * std::numbers::pi_v<float> * along + static_cast<float>(s);
            const float radius = 0.006f * std::min(1.0f, 4.0f * along);
            const Float3 centre = head.positions[head.offsets[s] + p] * 0.5f + head.roots[s] * 0.5f;
            strand.push_back(centre + Float3{radius * std::cos(turn), 0.0f, radius * std::sin(turn)} +
                             out * (0.01f * along));
        }
        strands.add(strand);
    }
    return strands;
}

class RodRun : public GpuSimulationTest {
  protected:
    /// Both engines, frame by frame.
    struct Both {
        StrandEngine gpu;
        runtime::Engine cpu;

        Both(const StrandSet& strands, const SimulationSettings& settings, const EngineOptions& options)
            : gpu(engineOf(strands.view(), settings, options)),
              cpu(*runtime::Engine::make(strands.view(), settings).engine) {}
        void step(const runtime::FrameInput& input) {
            const auto stepped = gpu.step(input);
            ASSERT_TRUE(stepped) << stepped.error().message();
            cpu.step(input);
        }
        std::vector<Float3> onGpu() {
            std::vector<Float3> positions(gpu.pointCount());
            EXPECT_TRUE(gpu.readPositions(positions));
            return positions;
        }
        std::vector<Float3> onCpu() const {
            std::vector<Float3> positions(cpu.pointCount());
            cpu.readPositions(positions);
            return positions;
        }
        double farthest() { return RodRun::farthest(onGpu(), onCpu()); }
        double meanDistance() {
            const std::vector<Float3> a = onGpu(), b = onCpu();
            double sum = 0.0;
            for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(length(a[i] - b[i]));
            return sum / static_cast<double>(a.size());
        }
    };
    /// How far hair comes, at most and in the mean, from where the CPU has it if its points begin some
    /// roundings off: hair that is about to slide off one side or the other is not sure of it.
    struct Spread {
        double farthest = 0.0, mean = 0.0;
    };
    template <class Frames>
    static Spread spreadOnCpu(const StrandSet& strands, const SimulationSettings& settings,
                              const Frames& frames) {
        std::vector<Float3> sure, nudged;
        Spread spread;
        for (std::uint32_t run = 0; run < 9; ++run) {
            StrandSet set = strands;
            test::Dice dice(run);
            if (run > 0)
                for (Float3& p : set.points) p = p + dice.inside(1e-7f);
            runtime::Engine engine = *runtime::Engine::make(set.view(), settings).engine;
            frames([&](const runtime::FrameInput& input) { engine.step(input); });
            std::vector<Float3>& into = run > 0 ? nudged : sure;
            into.resize(engine.pointCount());
            engine.readPositions(into);
            if (run == 0) continue;
            spread.farthest = std::max(spread.farthest, RodRun::farthest(nudged, sure));
            double sum = 0.0;
            for (std::size_t i = 0; i < sure.size(); ++i)
                sum += static_cast<double>(length(nudged[i] - sure[i]));
            spread.mean = std::max(spread.mean, sum / static_cast<double>(sure.size()));
        }
        return spread;
    }
    static double farthest(std::span<const Float3> a, std::span<const Float3> b) {
        double maximum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const auto off = static_cast<double>(length(a[i] - b[i]));
            if (!(off <= maximum)) maximum = off;
        }
        return maximum;
    }
    static Quat turned(double time) {
        return turnAboutY(0.3f * static_cast<float>(std::sin(2.0 * std::numbers::pi * time)));
    }
};

/// By the threads of a strand.
class EachRodLayout : public RodRun, public testing::WithParamInterface<LayoutOptions> {};
INSTANTIATE_TEST_SUITE_P(Layouts, EachRodLayout, testing::ValuesIn(kRodLayouts), [](const auto& layout) {
    return std::to_string(*layout.param.members) + "ThreadsAStrand";
});

/// Half a second on a root that turns to and fro: 0.05 mm is what rounding to 2e-8 m in each of 120 substeps
/// becomes in hair that swings freely, and less than is seen.
TEST_P(EachRodLayout, GentleMotionStaysWithTheCpu) {
    const auto offAfter = [](const StrandSet& strands, std::uint32_t clampedPoints) {
        SimulationSettings settings = rods();
        settings.substeps = 4;
        settings.clampedPoints = clampedPoints;
        settings.windSpeed = 2.0f;
        settings.angularStiffness = 0.5f;
        Both both(strands, settings, options(GetParam()));
        for (int f = 1; f <= 30; ++f) {
            const double time = f * static_cast<double>(kFrame);
            const auto roots = strands.roots({0.05f * static_cast<float>(time), 0.0f, 0.0f}, turned(time));
            both.step({kFrame, time, roots, {}});
        }
        return both.farthest();
    };
    EXPECT_LE(offAfter(manyPointCounts({2, 3, 5, 16, 33}), 1), 5e-5);
    EXPECT_LE(offAfter(manyPointCounts({2, 3, 70, 512}), 2), 5e-5);
}

/// A chain, soft and stiff hair beside each other in the blocks of one batch.
TEST_F(RodRun, StrandsOfTheirOwnStiffnessStayWithTheCpu) {
    StrandSet strands = manyPointCounts({16, 9, 16, 16, 33, 16});
    strands.stiffness = {1.0f, 0.25f, 4.0f, 0.0f, 30.0f, runtime::kMostStiffness};
    SimulationSettings settings = rods();
    settings.substeps = 4;
    settings.restGravity = 0.0f;
    Both both(strands, settings, options());
    StrandSet even = strands;
    even.stiffness.clear();
    runtime::Engine other = *runtime::Engine::make(even.view(), settings).engine;
    for (int f = 1; f <= 30; ++f) {
        const double time = f * static_cast<double>(kFrame);
        const auto roots = strands.roots({0.05f * static_cast<float>(time), 0.0f, 0.0f}, turned(time));
        both.step({kFrame, time, roots, {}});
        other.step({kFrame, time, roots, {}});
    }
    EXPECT_LE(both.farthest(), 5e-5);
    std::vector<Float3> elsewhere(other.pointCount());
    other.readPositions(elsewhere);
    EXPECT_GT(farthest(both.onGpu(), elsewhere), 0.01) << "else nothing is softer or stiffer";
}

/// Frames of any length, and none.
TEST_F(RodRun, FrameTimesMayChange) {
    const StrandSet strands = manyPointCounts({2, 9, 16, 40});
    Both both(strands, rods(), options());
    double time = 0.0;
    for (const float dt : {0.016f, 0.016f, 0.004f, 0.03f, 0.0f, 0.016f, 0.1f, 0.008f, 0.016f}) {
        time += static_cast<double>(dt);
        const auto roots = strands.roots({0.1f * static_cast<float>(time), 0.0f, 0.0f}, turned(time));
        both.step({dt, time, roots, {}});
    }
    EXPECT_LE(both.farthest(), 5e-5);
}

/// A head of locks that turns in the wind among spheres. Contacts amplify rounding, so that single points
/// part; the hair as a whole does not.
TEST_F(RodRun, CurlyHairStaysWithTheCpu) {
    const StrandSet strands = curls(96, 40);
    SimulationSettings settings = rods();
    settings.windSpeed = 3.0f;
    Both both(strands, settings, options());
    const std::vector<runtime::Sphere> spheres = scenes::HeadOfHair(1, 2).spheres;
    double energyGpu = 0.0, energyCpu = 0.0, deepestGpu = 0.0, deepestCpu = 0.0;
    for (int f = 1; f <= 60; ++f) {
        const double time = f * static_cast<double>(kFrame);
        const auto roots = strands.roots({}, turned(time));
        both.step({kFrame, time, roots, spheres});
        const runtime::Measurements gpu = both.gpu.measure().value(), cpu = both.cpu.measure();
        EXPECT_EQ(gpu.nanCount, 0u);
        deepestGpu = std::max(deepestGpu, gpu.maxPenetration);
        deepestCpu = std::max(deepestCpu, cpu.maxPenetration);
        energyGpu += gpu.kineticEnergy;
        energyCpu += cpu.kineticEnergy;
    }
    EXPECT_LE(deepestGpu, deepestCpu + 5e-4);
    EXPECT_LE(both.meanDistance(), 2e-3);
    EXPECT_NEAR(energyGpu, energyCpu, 0.05 * energyCpu);
}

/// A cut carries strands along rigidly, with what they remember; what is no number goes back to rest.
TEST_P(EachRodLayout, TeleportsAndRestoredStrands) {
    const StrandSet strands = curls(40, 12);
    Both both(strands, rods(), options(GetParam()));
    const Quat half{0.0f, std::sin(0.8f), 0.0f, std::cos(0.8f)};
    for (int f = 0; f < 12; ++f) {
        const bool cut = f >= 6;
        const auto roots =
            strands.roots({cut ? 10.0f : 0.02f * static_cast<float>(f), 0.0f, 0.0f}, cut ? half : Quat{});
        both.step({kFrame, 0.0, roots, {}});
    }
    EXPECT_LE(both.farthest(), 2e-5);

    runtime::State state = both.gpu.readState().value();
    // Of the eighth point of lane 3, y of the velocity.
    const std::size_t plane = runtime::planeSize(runtime::makeRestShape(strands.view())->blocks[0]);
    state.own[runtime::kOwnMotion][11 * plane + 7 * runtime::kBlockLanes + 3] =
        std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(both.gpu.writeState(state));
    const auto roots = strands.roots({10.0f, 0.0f, 0.0f}, half);
    ASSERT_TRUE(both.gpu.step({kFrame, 0.0, roots, {}}));
    EXPECT_EQ(both.gpu.report()->restoredStrands, 1u);
    EXPECT_EQ(both.gpu.measure()->nanCount, 0u);
    for (int f = 0; f < 5; ++f) ASSERT_TRUE(both.gpu.step({kFrame, 0.0, roots, {}}));
    EXPECT_EQ(both.gpu.report()->restoredStrands, 0u);
    EXPECT_EQ(both.gpu.measure()->nanCount, 0u);
}

/// Falls asleep and wakes with the CPU.
TEST_P(EachRodLayout, SleepsAndWakes) {
    StrandSet strands;
    for (int s = 0; s < 64; ++s) {
        // Two blocks, a metre apart.
        const Float3 root{s < 32 ? 0.0f : 1.0f, 0.1f, 0.001f * static_cast<float>(s)};
        strands.add(root, {0.0f, -1.0f, 0.0f}, 0.02f, 8);
    }
    SimulationSettings s = rods();
    s.sleepDelay = 0.1f;
    Both both(strands, s, options(GetParam()));
    std::vector<RootFrame> roots = strands.roots();
    // Near, without touching: hair that rests on one is slow only now and then.
    std::vector<runtime::Sphere> spheres{{{0.04f, 0.0f, 0.0f}, 0.017f}};
    const auto run = [&](int frames) {
        for (int f = 0; f < frames; ++f) both.step({kFrame, 0.0, roots, spheres});
        return both.gpu.report()->asleep;
    };
    EXPECT_EQ(run(240), 64u);
    const std::vector<Float3> before = both.onGpu();
    run(10);
    EXPECT_EQ(farthest(both.onGpu(), before), 0.0);
    EXPECT_EQ(both.cpu.measure().asleep, 64u);
    spheres[0].center_ws.x = 0.042f;
    EXPECT_EQ(run(1), 32u);
    EXPECT_EQ(run(240), 64u);
    roots[40].position.y += 0.001f;
    EXPECT_EQ(run(1), 32u);
    EXPECT_EQ(both.cpu.measure().asleep, 32u);
    EXPECT_LE(both.farthest(), 2e-5);
}

/// Equal input, equal bits; a state that was read goes on as if nothing had been.
TEST_P(EachRodLayout, StatesCanBeTakenAndPutBack) {
    const StrandSet strands = curls(40, 9);
    const std::vector<runtime::Sphere> spheres = scenes::HeadOfHair(1, 2).spheres;
    SimulationSettings settings = rods();
    settings.windSpeed = 5.0f;
    const auto run = [&](StrandEngine& engine, int first, int last) {
        for (int f = first; f <= last; ++f) {
            const double time = f * static_cast<double>(kFrame);
            const auto roots = strands.roots({}, turned(time));
            ASSERT_TRUE(engine.step({kFrame, time, roots, spheres}));
        }
    };
    StrandEngine a = engineOf(strands.view(), settings, options(GetParam())),
                 b = engineOf(strands.view(), settings, options(GetParam()));
    run(a, 1, 8);
    run(b, 1, 4);
    const runtime::State middle = b.readState().value();
    run(b, 5, 8);
    EXPECT_EQ(a.stateHash().value(), b.stateHash().value());
    ASSERT_TRUE(b.writeState(middle));
    run(b, 5, 8);
    EXPECT_EQ(a.stateHash().value(), b.stateHash().value());
}

/// Springs become rods and rods springs where they are, as on the CPU.
TEST_F(RodRun, TheModelMayChange) {
    const StrandSet strands = curls(40, 12);
    SimulationSettings springs = rods();
    springs.strandModel = runtime::StrandModel::springs;
    for (const LayoutOptions& layout : {kHeldLayouts[0], kHeldLayouts[1]}) {
        SCOPED_TRACE(nameOf(layout));
        Both both(strands, springs, options(layout));
        int f = 0;
        const auto run = [&](const SimulationSettings& settings) {
            ASSERT_TRUE(both.gpu.setSettings(settings));
            ASSERT_EQ(both.cpu.setSettings(settings), "");
            for (const int end = f + 6; f < end; ++f) {
                const double time = f * static_cast<double>(kFrame);
                const auto roots = strands.roots({}, turned(time));
                both.step({kFrame, time, roots, {}});
            }
        };
        run(springs);
        run(rods());
        SimulationSettings other = rods();
        other.angularStiffness = 0.6f;
        run(other);
        EXPECT_LE(both.farthest(), 2e-5);
        run(springs);
        EXPECT_EQ(both.gpu.measure()->nanCount, 0u);
        EXPECT_LE(both.meanDistance(), 1e-3);
    }
}

/// Hair against hair changes velocities, which rods keep apart from their ways.
TEST_F(RodRun, PushesBetweenFrames) {
    const StrandSet strands = curls(40, 12);
    EngineOptions with = options();
    with.hairVolume.emplace();
    with.hairVolume->targetDensity = 1e4f;
    with.hairVolume->repulsion = 2.0f;
    with.hairVolume->friction = 40.0f;
    Both both(strands, rods(), with);
    auto volume = runtime::HairVolume::make(*with.hairVolume);
    ASSERT_TRUE(volume.volume);
    std::vector<Float3> positions(both.cpu.pointCount()), before(positions), after(positions);
    for (int f = 0; f < 10; ++f) {
        const double time = f * static_cast<double>(kFrame);
        const auto roots = strands.roots({}, turned(time));
        both.step({kFrame, time, roots, {}});
        both.cpu.readPositions(positions);
        both.cpu.readVelocities(before);
        after = before;
        volume.volume->apply(positions, after, kFrame);
        for (std::size_t p = 0; p < after.size(); ++p) after[p] = after[p] - before[p];
        both.cpu.addVelocities(after);
    }
    // The volume's cells are in single precision here.
    EXPECT_LE(both.farthest(), 2e-4);
}

/// Whatever comes, positions are numbers and segments keep their lengths. Strands without any stiffness may
/// be put back to rest, as on the CPU: what their rotation about themselves is, only rounding says.
TEST_F(RodRun, StandsFiftyStorms) {
    test::Dice dice(99);
    const StrandSet strands = curls(36, 14);
    for (int storm = 0; storm < 50; ++storm) {
        SCOPED_TRACE(storm);
        SimulationSettings s = rods();
        s.sleepSpeed = 0.0f;
        s.substeps = storm % 4 == 0 ? 1 : 4;
        s.clampedPoints = storm % 3 == 0 ? 1 : 2;
        s.windSpeed = dice.between(0.0f, 80.0f);
        s.windGustiness = dice.between(0.0f, 1.0f);
        s.windKind = static_cast<runtime::WindKind>(storm % 4);
        s.airDrag = dice.between(0.0f, 50.0f);
        s.angularStiffness = storm % 10 == 0 ? 0.0f : dice.between(0.0f, 0.99f);
        s.torsionRatio = dice.between(0.05f, 10.0f);
        if (storm % 3 == 0) s.sectionRatio = dice.between(0.2f, 1.0f);
        s.bendDampingTime = storm % 2 == 0 ? 0.0f : dice.between(0.0f, 0.3f);
        s.dampingTime = storm % 5 == 0 ? 0.0f : 0.5f;
        s.restitution = dice.between(0.0f, 1.0f);
        s.friction = dice.between(0.0f, 1.0f);
        StrandEngine engine = engineOf(strands.view(), s, options());
        std::vector<runtime::Sphere> spheres = scenes::HeadOfHair(1, 2).spheres;
        double time = 0.0;
        for (int f = 0; f < 12; ++f) {
            const float dt = dice.between(0.002f, 0.06f);
            time += static_cast<double>(dt);
            for (runtime::Sphere& sphere : spheres) sphere.center_ws = sphere.center_ws + dice.inside(0.05f);
            const auto roots = strands.roots(dice.inside(0.3f), dice.turn(1.0f));
            ASSERT_TRUE(engine.step({dt, time, roots, spheres}));
            if (s.angularStiffness > 0.0f) {
                ASSERT_EQ(engine.report()->restoredStrands, 0u);
            }
            const auto measured = engine.measure();
            ASSERT_TRUE(measured);
            ASSERT_EQ(measured->nanCount, 0u);
            ASSERT_LE(measured->maxStretch, 1e-3);
        }
    }
}

TEST_F(RodRun, OriginsThatMoveChangeNothing) {
    const StrandSet strands = curls(40, 16);
    SimulationSettings settings = rods();
    settings.windSpeed = 2.0f;
    Both both(strands, settings, options());
    for (int f = 1; f <= 40; ++f) {
        const double walk = 0.02 * f, origin = 1e4 + std::floor(walk / 0.25) * 0.25;
        const auto x = static_cast<float>(1e4 + walk - origin);
        const std::vector<runtime::Sphere> spheres{{{x, 0.0f, 0.0f}, 0.085f}};
        const auto roots = strands.roots({x, 0.0f, 0.0f});
        runtime::FrameInput input{kFrame, f / 60.0, roots, spheres};
        input.origin_ws = {origin, 0.0, 0.0};
        both.step(input);
    }
    EXPECT_LE(both.meanDistance(), 1e-4);
}

TEST_F(RodRun, StrandsLieOnACapsuleAsOnTheCpu) {
    StrandSet strands;
    for (std::uint32_t i = 0; i < 8; ++i)
        strands.add({0.0f, 0.0f, 0.015f * static_cast<float>(i)}, {1.0f, 0.0f, 0.0f}, 0.015f, 12);
    SimulationSettings s = rods();
    s.restGravity = 0.0f;
    s.angularStiffness = 0.05f;
    s.collisionRadiusRoot = s.collisionRadiusTip = 0.0f;
    // Neither end reaches a strand.
    const std::vector<runtime::Sphere> ends{{{0.09f, -0.08f, -0.06f}, 0.05f},
                                            {{0.09f, -0.08f, 0.165f}, 0.05f}};
    const std::vector<runtime::Capsule> capsules{{0, 1}};
    const std::vector<RootFrame> roots = strands.roots();
    const auto frames = [&](bool joined, const auto& step) {
        for (int f = 1; f <= 20; ++f) {
            runtime::FrameInput input{kFrame, f / 60.0, roots};
            input.spheres = ends;
            if (joined) input.capsules = capsules;
            step(input);
        }
    };
    Both held(strands, s, options());
    frames(true, [&](const runtime::FrameInput& input) { held.step(input); });
    runtime::Engine missed = *runtime::Engine::make(strands.view(), s).engine;
    frames(false, [&](const runtime::FrameInput& input) { missed.step(input); });
    std::vector<Float3> past(missed.pointCount());
    missed.readPositions(past);
    EXPECT_GT(RodRun::farthest(held.onGpu(), past), 0.03) << "without it they fall past";
    const Spread spread = spreadOnCpu(strands, s, [&](const auto& step) { frames(true, step); });
    EXPECT_LT(spread.farthest, 5e-3);
    EXPECT_LT(held.meanDistance(), std::max(1e-4, 2.0 * spread.mean));
    EXPECT_LT(held.farthest(), std::max(1e-3, 2.0 * spread.farthest));
    for (const Float3& x : held.onGpu()) {
        const runtime::Sphere nearest = runtime::nearestOfCapsule(ends[0], ends[1], x);
        EXPECT_LT(nearest.radius - length(x - nearest.center_ws), 0.001f);
    }
}

/// Two that narrow to the end that they share, among more shapes than a constant buffer holds.
TEST_F(RodRun, CapsulesThatMoveAndNarrowTakeStrandsAlongAsOnTheCpu) {
    StrandSet strands;
    for (std::uint32_t i = 0; i < 12; ++i)
        strands.add({0.01f * static_cast<float>(i), 0.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.012f, 14);
    const std::vector<RootFrame> roots = strands.roots();
    const std::vector<runtime::Capsule> capsules{{0, 1}, {1, 2}, {2, 2}, {3, 40}};
    for (const std::size_t others : {0u, 40u}) {
        SCOPED_TRACE(others);
        const auto frames = [&](const auto& step) {
            for (int f = 1; f <= 30; ++f) {
                const float way = 0.003f * static_cast<float>(f);
                std::vector<runtime::Sphere> spheres{{{-0.06f, -0.09f, -0.14f + way}, 0.03f},
                                                     {{0.05f, -0.12f, -0.07f + way}, 0.015f},
                                                     {{0.18f, -0.08f, -0.15f + way}, 0.04f}};
                for (std::size_t k = 0; k < others; ++k)
                    spheres.push_back({{1.0f + 0.1f * static_cast<float>(k), 0.0f, 0.0f}, 0.04f});
                runtime::FrameInput input{kFrame, f / 60.0, roots};
                input.spheres = spheres;
                input.capsules = capsules;
                step(input);
            }
        };
        Both both(strands, rods(), options());
        frames([&](const runtime::FrameInput& input) { both.step(input); });
        const Spread spread = spreadOnCpu(strands, rods(), frames);
        EXPECT_GT(RodRun::farthest(both.onGpu(), strands.view().restPositions_ss), 0.02);
        EXPECT_LT(spread.farthest, 5e-3);
        EXPECT_LT(both.meanDistance(), std::max(1e-4, 2.0 * spread.mean));
        EXPECT_LT(both.farthest(), std::max(1e-3, 2.0 * spread.farthest));
    }
}

}  // namespace
}  // namespace hairloom::gpu_simulation
