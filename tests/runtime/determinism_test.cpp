// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "runtime/engine/kernels.h"
#include "runtime/models/springs/spring_kernels.h"
#include "tests/runtime/instruction_sets.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

SimulationSettings everything() {
    SimulationSettings s = springSettings();
    s.windSpeed = 6.0f;
    s.restitution = 0.2f;
    return s;
}

/// As everything(), for rods.
SimulationSettings rods() {
    SimulationSettings s = everything();
    s.strandModel = StrandModel::rods;
    return s;
}

const std::vector<Sphere> kSpheres{{{0.1f, 0.02f, 0.0f}, 0.05f}, {{0.3f, 0.0f, 0.01f}, 0.07f}};

void runMoving(Engine& engine, const Strands& strands, int first, int last) {
    for (int f = first; f < last; ++f) {
        const float angle = 0.4f * std::sin(static_cast<float>(f) * 0.2f);
        const auto roots = strands.roots({0.01f * std::sin(static_cast<float>(f)), 0.0f, 0.0f},
                                         turnAbout({0.0f, 1.0f, 0.0f}, angle));
        engine.step({1.0f / 60.0f, f / 60.0, roots, kSpheres});
    }
}

std::uint64_t hashAfterMotion(const Strands& strands, const SimulationSettings& s, Host host = {}) {
    Engine engine = makeEngine(strands, s, std::move(host));
    runMoving(engine, strands, 0, 40);
    EXPECT_EQ(engine.measure().nanCount, 0u);
    return engine.stateHash();
}

TEST(Determinism, SameBitsForAnyNumberOfThreadsAndOrder) {
    const Strands strands = tuft(500, true);
    const std::uint64_t serial = hashAfterMotion(strands, everything());
    EXPECT_EQ(serial, hashAfterMotion(strands, everything(), hostWithThreads(1)));
    EXPECT_EQ(serial, hashAfterMotion(strands, everything(), hostWithThreads(7)));
    EXPECT_EQ(serial, hashAfterMotion(strands, everything(), hostWithThreads(3, true)));
}

/// Those that round a product and a sum once agree with each other, and so do those that round each.
TEST(Determinism, SameBitsForEveryInstructionSetThatRoundsAlike) {
    const Strands strands = tuft(50, true);
    SimulationSettings segments = everything();
    segments.collisionSegments = true;
    for (const SimulationSettings& s : {everything(), segments, rods()}) {
        std::optional<std::uint64_t> expected[2];
        forEveryInstructionSet([&] {
            const std::uint64_t hash = hashAfterMotion(strands, s);
            auto& first = expected[kernels().fuses ? 1 : 0];
            EXPECT_EQ(first.value_or(hash), hash) << Engine::instructionSet();
            first = hash;
        });
        EXPECT_TRUE(expected[0].has_value());
    }
}

/// Rounding apart leaves them close together for as long as a short motion does not tear them apart.
TEST(Determinism, InstructionSetsThatRoundOtherwiseStayNear) {
    const Strands strands = tuft(50, true);
    std::vector<Float3> best;
    forEveryInstructionSet([&] {
        Engine engine = makeEngine(strands, everything());
        runMoving(engine, strands, 0, 2);
        std::vector<Float3> positions(engine.pointCount());
        engine.readPositions(positions);
        if (best.empty()) best = positions;
        for (std::size_t p = 0; p < positions.size(); ++p)
            ASSERT_LT(length(positions[p] - best[p]), 1e-5f) << Engine::instructionSet() << " point " << p;
    });
}

/// A host with a clock has each stage by itself, one without has those that follow each other in one pass.
TEST(Determinism, SameBitsWhetherStagesAreTimedOrNot) {
    const Strands strands = tuft(6, true);
    Host clock;
    clock.nanoseconds = [] { return std::uint64_t{0}; };
    for (int which = 0; which < 12; ++which) {
        SimulationSettings s = springSettings();
        s.lengthIterations = which % 2 == 0 ? 1 : 3;
        s.airDrag = which % 3 > 0 ? 2.0f : 0.0f;
        s.windSpeed = which % 3 > 1 ? 6.0f : 0.0f;
        if (which / 3 % 2 > 0) s.gravity = {};
        if (which / 6 > 0) s.dampingTime = 0.0f;
        Engine plain = makeEngine(strands, s), timed = makeEngine(strands, s, clock);
        runMoving(plain, strands, 0, 8);
        runMoving(timed, strands, 0, 8);
        EXPECT_EQ(plain.stateHash(), timed.stateHash()) << which;
    }
}

/// What is called for stages, by passesOf or singlePassesOf.
std::vector<Stage> callsFor(std::initializer_list<StageId> stages, decltype(passesOf) makePasses) {
    const Passes made = makePasses({stages.begin(), stages.size()}, springKernels());
    return {made.calls.begin(), made.calls.begin() + made.count};
}

Stage alone(StageId id) {
    return springKernels().stages[static_cast<std::size_t>(id)];
}

TEST(Determinism, StagesThatFollowEachOtherAreOnePass) {
    using enum StageId;
    const SpringKernels& table = springKernels();
    const auto passes = [](std::initializer_list<StageId> stages) { return callsFor(stages, passesOf); };
    EXPECT_EQ(passes({roots, damping, wind, gravity, verlet, length}),
              (std::vector<Stage>{alone(roots), table.moves[1][2][1], alone(length)}));
    EXPECT_EQ(passes({roots, verlet}), (std::vector<Stage>{alone(roots), table.moves[0][0][0]}));
    EXPECT_EQ(passes({roots, verlet, angular, length, continuousCollision}),
              (std::vector<Stage>{alone(roots), table.moves[0][0][0], table.bendAndProject[1],
                                  alone(continuousCollision)}));
    EXPECT_EQ(passes({angularStraight, length}), (std::vector<Stage>{table.bendAndProject[0]}));
    EXPECT_EQ(passes({angular, collision}), (std::vector<Stage>{alone(angular), alone(collision)}));
    EXPECT_EQ(passes({continuousCollision, collision, extension}),
              (std::vector<Stage>{table.bothCollisions[0], alone(extension)}));
    EXPECT_EQ(passes({continuousCollision, collisionBack}), (std::vector<Stage>{table.bothCollisions[1]}));
    // Another force between them, or another integrator after them: each by itself.
    EXPECT_EQ(passes({damping, gravity, springs, verlet}),
              (std::vector<Stage>{alone(damping), alone(gravity), alone(springs), table.moves[0][0][0]}));
    EXPECT_EQ(passes({open, drag, gravity, explicitEuler}),
              (std::vector<Stage>{alone(open), alone(drag), alone(gravity), alone(explicitEuler)}));
}

TEST(Determinism, SeparateStagesPassTheDisplacementOn) {
    using enum StageId;
    const auto singles = [](std::initializer_list<StageId> stages) {
        return callsFor(stages, singlePassesOf);
    };
    const auto opens = [](StageId id) {
        return springKernels().partsOfMove[0][static_cast<std::size_t>(id)];
    };
    const auto follows = [](StageId id) {
        return springKernels().partsOfMove[1][static_cast<std::size_t>(id)];
    };
    EXPECT_EQ(singles({roots, damping, wind, gravity, verlet, angular, length}),
              (std::vector<Stage>{alone(roots), opens(damping), follows(wind), follows(gravity),
                                  follows(verlet), alone(angular), alone(length)}));
    EXPECT_EQ(
        singles({roots, verlet, continuousCollision, collision}),
        (std::vector<Stage>{alone(roots), opens(verlet), alone(continuousCollision), alone(collision)}));
    // What stands between them reads positions.
    EXPECT_EQ(singles({damping, gravity, springs, verlet}),
              (std::vector<Stage>{alone(damping), alone(gravity), alone(springs), opens(verlet)}));
}

/// Few spheres are looked up in a list of the points near them that holds for several substeps, more than 64
/// are not.
TEST(Determinism, AListOfNearPointsChangesNothing) {
    const Strands strands = tuft(40, true);
    std::vector<Sphere> many = kSpheres;
    for (int i = 0; i < 70; ++i) many.push_back({{2.0f + 0.1f * static_cast<float>(i), 3.0f, 0.0f}, 0.02f});
    for (const float wind : {0.0f, 3.0f, 40.0f}) {
        SimulationSettings s = everything();
        s.windSpeed = wind;
        Engine few = makeEngine(strands, s), all = makeEngine(strands, s);
        for (int f = 0; f < 30; ++f) {
            // Some frames throw the hair about, others hardly move it.
            const float t = static_cast<float>(f);
            const auto roots = strands.roots({0.02f * std::sin(t), 0.004f * t, 0.0f},
                                             turnAbout({0.0f, 1.0f, 0.0f}, 0.6f * std::sin(0.3f * t)));
            std::vector<Sphere> now = kSpheres, withFar = many;
            now[1].center_ws.x += 0.03f * std::sin(0.5f * t);
            withFar[1] = now[1];
            few.step({1.0f / 60.0f, t / 60.0, roots, now});
            all.step({1.0f / 60.0f, t / 60.0, roots, withFar});
            ASSERT_EQ(few.stateHash(), all.stateHash()) << "frame " << f << " wind " << wind;
        }
    }
}

TEST(Determinism, CopyContinuesWithTheSameBits) {
    const Strands strands = tuft(40, true);
    for (const SimulationSettings& s : {everything(), rods()}) {
        Engine engine = makeEngine(strands, s);
        runMoving(engine, strands, 0, 20);
        Engine copy = engine;
        runMoving(engine, strands, 20, 40);
        runMoving(copy, strands, 20, 40);
        EXPECT_EQ(engine.stateHash(), copy.stateHash());
        EXPECT_EQ(engine.stateHash(), hashAfterMotion(strands, s));
    }
}

TEST(Determinism, DisabledEffectChangesNoBits) {
    const Strands strands = tuft(70, true);
    SimulationSettings never = springSettings();
    Engine bareEngine = makeEngine(strands, never);
    run(bareEngine, strands, 30);

    SimulationSettings zeroWind = never;
    zeroWind.windDirection = {0.0f, 0.0f, 1.0f};
    zeroWind.windGustiness = 1.0f;
    zeroWind.windSeed = 77;
    Engine still = makeEngine(strands, zeroWind);
    const std::vector<Sphere> far{{{90.0f, 0.0f, 0.0f}, 1.0f}};
    run(still, strands, 30, 1.0f / 60.0f, far);
    EXPECT_FALSE(still.plan().on(Effect::collision));
    EXPECT_EQ(still.stateHash(), bareEngine.stateHash());
}

/// Lanes are independent: a strand moves alike alone and among others, whatever the block's filling.
TEST(Determinism, StrandsDoNotAffectEachOther) {
    for (std::uint32_t count = 1; count <= 20; ++count) {
        const Strands all = tuft(count, true);
        Engine together = makeEngine(all, everything());
        run(together, all, 10, 1.0f / 60.0f, kSpheres);
        const std::vector<Float3> positions = positionsOf(together);
        for (std::uint32_t s = 0; s < count; ++s) {
            Strands one;
            one.points.assign(all.points.begin() + all.offsets[s], all.points.begin() + all.offsets[s + 1]);
            one.offsets.push_back(static_cast<std::uint32_t>(one.points.size()));
            Engine alone = makeEngine(one, everything());
            run(alone, one, 10, 1.0f / 60.0f, kSpheres);
            const std::vector<Float3> expected = positionsOf(alone);
            for (std::size_t p = 0; p < expected.size(); ++p)
                ASSERT_EQ(positions[all.offsets[s] + p], expected[p]) << s;
        }
    }
}

TEST(Determinism, StepsWithoutStrands) {
    const Strands none;
    Engine engine = makeEngine(none, {});
    run(engine, none, 3);
    EXPECT_EQ(engine.pointCount(), 0u);
}

}  // namespace
}  // namespace hairloom::runtime
