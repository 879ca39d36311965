// SPDX-License-Identifier: GPL-3.0-or-later
// What is off costs nothing and leaves no trace: the same bits, stages and bytes as if it had never been
// there.
#include <functional>

#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

using Change = std::function<void(SimulationSettings&)>;
using Spheres = std::vector<Sphere>;

/// What moves strands: springs with an integrator, or rods.
struct Mover {
    StrandModel model = StrandModel::springs;
    Integrator integrator = Integrator::verlet;

    std::string name() const { return model == StrandModel::rods ? "rods" : nameOf(integrator); }
};

/// An effect, how it is had, and how it is not.
struct Case {
    Effect effect;
    Change on, off;
    /// Changes fields that only the effect reads.
    Change unread = [](SimulationSettings&) {};
    Spheres spheresOn = {}, spheresOff = {};
    bool moving = true;  ///< roots and spheres
};

const Spheres kNear{{{0.1f, 0.02f, 0.0f}, 0.05f}, {{0.06f, 0.0f, 0.01f}, 0.04f}};
const Spheres kFar{{{90.0f, 0.0f, 0.0f}, 1.0f}, {{0.0f, 70.0f, 0.0f}, 2.0f}};
/// A tenth of the strands' reach, so that a frame's motion passes through it.
const Spheres kTiny{{{0.1f, 0.02f, 0.0f}, 0.004f}, {{0.06f, 0.0f, 0.01f}, 0.004f}};
/// Below the hair, so large that nothing passes it in a substep.
const Spheres kGround{{{0.0f, -50.05f, 0.0f}, 50.0f}};

/// Those that a setting or the frame's spheres control: all but the length of rods.
std::vector<Case> casesOf(StrandModel model) {
    const bool rods = model == StrandModel::rods;
    using S = SimulationSettings;
    const Change same = [](S&) {};
    const Change touching = [](S& s) {
        s.friction = 0.9f;
        s.restitution = 0.7f;
        s.penaltyFrequency = 50.0f;
        s.collisionResponse = CollisionResponse::backward;
        s.collisionRadiusRoot = 0.003f;
        s.collisionRadiusTip = 0.004f;
    };
    const Change blowing = [](S& s) {
        s.windKind = WindKind::gusting;
        s.windDirection = {0.0f, 0.0f, 1.0f};
        s.windGustiness = 1.0f;
        s.windFrequency = 5.0f;
        s.windGustSize = 0.1f;
        s.windSeed = 77;
    };
    const Change bending = [](S& s) {
        s.angularCurve = Ramp::straight(1.0f, 0.1f);
        s.bendDampingTime = 0.2f;
        s.restGravity = 0.3f;
        s.angularMethod = AngularMethod::exact;
        s.torsionRatio = 0.2f;
        s.sectionRatio = 0.5f;
    };
    std::vector<Case> cases{
        {Effect::damping, [](S& s) { s.dampingTime = 0.3f; }, [](S& s) { s.dampingTime = 0.0f; }},
        {Effect::gravity, same, [](S& s) { s.gravity = {}; }, [](S& s) { s.restGravity = 0.4f; }},
        {Effect::drag, same, [](S& s) { s.airDrag = 0.0f; },
         [blowing](S& s) {
             blowing(s);
             s.windSpeed = 9.0f;
         }},
        {Effect::wind, [](S& s) { s.windSpeed = 6.0f; }, [](S& s) { s.windSpeed = 0.0f; }, blowing},
        {Effect::angular, same, [](S& s) { s.angularStiffness = 0.0f; }, bending},
        {.effect = Effect::collision,
         .on = same,
         .off = same,
         .unread = touching,
         .spheresOn = kNear,
         .spheresOff = {}},
        {.effect = Effect::collision,
         .on = same,
         .off = same,
         .unread = touching,
         .spheresOn = kNear,
         .spheresOff = kFar},
        {.effect = Effect::collisionRadius,
         .on = [](S& s) { s.collisionRadiusTip = 0.004f; },
         .off = [](S& s) { s.collisionRadiusTip = 0.0f; },
         .spheresOn = kNear,
         .spheresOff = kNear},
        {.effect = Effect::continuousCollision,
         .on = same,
         .off =
             [rods](S& s) {
                 if (!rods) s.collisionResponse = CollisionResponse::penalty;
             },
         .unread =
             [rods](S& s) {
                 if (!rods) s.friction = 0.8f, s.restitution = 0.9f;
             },
         .spheresOn = kTiny,
         .spheresOff = rods ? kGround : kTiny},
        {.effect = Effect::sleep,
         .on = [](S& s) { s.sleepSpeed = 0.5f, s.sleepDelay = 0.05f; },
         .off = [](S& s) { s.sleepSpeed = 0.0f; },
         .unread = [](S& s) { s.sleepDelay = 7.0f; },
         .moving = false},
    };
    if (rods) {
        // Of straight hair that does not carry its weight.
        cases.push_back(
            {Effect::torsion, same, [](S& s) { s.restGravity = 0.0f; }, [](S& s) { s.torsionRatio = 0.2f; }});
        cases.push_back({Effect::torsion,
                         [](S& s) {
                             s.restGravity = 0.0f;
                             s.sectionRatio = 0.5f;
                         },
                         [](S& s) { s.sectionRatio = 1.0f; }, [](S& s) { s.torsionRatio = 0.2f; }});
    } else {
        // Angular springs alone do not hold together what may stretch freely.
        cases.push_back({Effect::length, [](S& s) { s.angularStiffness = 0.0f; },
                         [](S& s) { s.lengthIterations = 0; },
                         [](S& s) {
                             s.maximalExtension = 0.3f;
                             s.springFrequency = 20.0f;
                         }});
    }
    return cases;
}

/// The head turns and shifts in frames [first, end) and stands still from frame `stop` on; spheres go with
/// it.
void runCase(Engine& engine, const Strands& strands, const Case& c, const Spheres& spheres, int first,
             int end, int stop = 1000) {
    for (int f = first; f < end; ++f) {
        const float t = c.moving ? static_cast<float>(std::min(f, stop)) : 0.0f;
        const Float3 shift{0.01f * std::sin(0.5f * t), 0.0f, 0.0f};
        const auto roots = strands.roots(shift, turnAbout({0.0f, 1.0f, 0.0f}, 0.2f * std::sin(0.3f * t)));
        Spheres moved = spheres;
        for (Sphere& sphere : moved) sphere.center_ws = sphere.center_ws + shift;
        engine.step({1.0f / 60.0f, f / 60.0, roots, moved});
        ASSERT_EQ(engine.lastStep().restoredStrands, 0u) << "the scene should be a sound one";
    }
}

SimulationSettings base(const Mover& mover) {
    SimulationSettings s = springSettings();
    s.strandModel = mover.model;
    s.integrator = mover.integrator;
    s.angularStiffness = 0.001f;
    s.substeps = mover.model == StrandModel::rods ? 3 : 12;
    s.sleepSpeed = 0.0f;
    return s;
}

struct Pair {
    SimulationSettings with, without;
};
Pair settingsOf(const Case& c, const Mover& mover) {
    Pair pair{base(mover), {}};
    c.on(pair.with);
    pair.without = pair.with;
    c.off(pair.without);
    return pair;
}

std::vector<StageId> stagesOf(const Engine& engine) {
    const auto stages = engine.plan().stages();
    return {stages.begin(), stages.end()};
}

/// The bytes of every effect but bookkeeping of wind, which has no arrays.
std::vector<std::size_t> bytesOf(const Engine& engine) {
    std::vector<std::size_t> bytes{engine.baseBytes()};
    for (std::uint32_t e = 0; e < kEffectCount; ++e)
        bytes.push_back(engine.effectBytes(static_cast<Effect>(e)));
    return bytes;
}

class EffectsOff : public testing::TestWithParam<Mover> {};

/// What the other fields of the effect say does not matter while it is off.
TEST_P(EffectsOff, OffEffectChangesNoBits) {
    const Strands strands = tuft(20, true);
    for (const Case& c : casesOf(GetParam().model)) {
        SCOPED_TRACE(effectName(c.effect));
        const Pair settings = settingsOf(c, GetParam());
        Engine never = makeEngine(strands, settings.without);
        runCase(never, strands, c, c.spheresOff, 0, 15);
        EXPECT_FALSE(never.plan().on(c.effect)) << never.plan().why(c.effect);

        Engine with = makeEngine(strands, settings.with);
        runCase(with, strands, c, c.spheresOn, 0, 15);
        EXPECT_TRUE(with.plan().on(c.effect)) << with.plan().why(c.effect);
        EXPECT_NE(with.stateHash(), never.stateHash()) << "with it, strands should move otherwise";

        SimulationSettings off = settings.without;
        c.unread(off);
        Engine engine = makeEngine(strands, off);
        runCase(engine, strands, c, c.spheresOff, 0, 15);
        EXPECT_EQ(engine.stateHash(), never.stateHash());
        EXPECT_EQ(stagesOf(engine), stagesOf(never));
        for (const StageId stage : engine.plan().stages()) EXPECT_NE(stageEffect(stage), c.effect);
        EXPECT_EQ(engine.effectBytes(c.effect), 0u);
        EXPECT_EQ(bytesOf(engine), bytesOf(never));
    }
}

/// Had and given up again between two frames, in motion, it leaves no trace in any later bit.
TEST_P(EffectsOff, OnThenOffChangesNoBits) {
    const Strands strands = tuft(20, true);
    for (const Case& c : casesOf(GetParam().model)) {
        SCOPED_TRACE(effectName(c.effect));
        const Pair settings = settingsOf(c, GetParam());
        Engine never = makeEngine(strands, settings.without);
        runCase(never, strands, c, c.spheresOff, 0, 10);
        Engine engine = never;
        ASSERT_EQ(never.setSettings(settings.without), "");
        ASSERT_EQ(engine.setSettings(settings.with), "");
        ASSERT_EQ(engine.setSettings(settings.without), "");
        runCase(never, strands, c, c.spheresOff, 10, 20);
        runCase(engine, strands, c, c.spheresOff, 10, 20);
        EXPECT_EQ(engine.stateHash(), never.stateHash());
        EXPECT_EQ(stagesOf(engine), stagesOf(never));
        EXPECT_EQ(bytesOf(engine), bytesOf(never));
    }
}

/// While it runs on: the list and the memory shrink at the next step, to what they would be without it.
TEST_P(EffectsOff, TurningOffMidRunRemovesStagesAndMemory) {
    const Strands strands = tuft(20, true);
    for (const Case& c : casesOf(GetParam().model)) {
        SCOPED_TRACE(effectName(c.effect));
        const auto [with, without] = settingsOf(c, GetParam());
        Engine engine = makeEngine(strands, with);
        runCase(engine, strands, c, c.spheresOn, 0, 15);
        ASSERT_EQ(engine.setSettings(without), "");
        runCase(engine, strands, c, c.spheresOff, 15, 18, 15);
        EXPECT_FALSE(engine.plan().on(c.effect)) << engine.plan().why(c.effect);
        Engine never = makeEngine(strands, without);
        runCase(never, strands, c, c.spheresOff, 0, 18, 15);
        for (const StageId stage : engine.plan().stages()) EXPECT_NE(stageEffect(stage), c.effect);
        EXPECT_EQ(engine.effectBytes(c.effect), 0u);
        EXPECT_EQ(bytesOf(engine), bytesOf(never));
    }
}

INSTANTIATE_TEST_SUITE_P(Movers, EffectsOff,
                         testing::Values(Mover{StrandModel::rods},
                                         Mover{StrandModel::springs, Integrator::verlet},
                                         Mover{StrandModel::springs, Integrator::velocityVerlet},
                                         Mover{StrandModel::springs, Integrator::leapfrog},
                                         Mover{StrandModel::springs, Integrator::implicitEuler},
                                         Mover{StrandModel::springs, Integrator::rk4}),
                         [](const auto& tested) { return tested.param.name(); });

/// All effects at once off: what is left is the integrator, and the roots that move it.
TEST(EffectsOff, AllOffRunsOnlyRootsAndIntegrator) {
    const Strands strands = tuft(20, true);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 3, 1.0f / 60.0f);
    EXPECT_EQ(stagesOf(engine), (std::vector<StageId>{StageId::roots, StageId::verlet}));
    for (std::uint32_t e = 0; e < kEffectCount; ++e)
        EXPECT_EQ(engine.effectBytes(static_cast<Effect>(e)), 0u) << effectName(static_cast<Effect>(e));
}

/// Rods solve all at once: what is left is that solve, of a chain, without the arrays of bending and twist.
TEST(EffectsOff, AllOffLeavesRodsTheirSolve) {
    const Strands strands = tuft(32);
    SimulationSettings s = bare();
    s.strandModel = StrandModel::rods;
    s.substeps = 2;
    const auto memoryOf = [&](const SimulationSettings& settings) {
        Engine engine = makeEngine(strands, settings);
        run(engine, strands, 3);
        EXPECT_EQ(stagesOf(engine), (std::vector<StageId>{StageId::roots, StageId::rod}));
        std::size_t bytes = engine.baseBytes();
        for (std::uint32_t e = 0; e < kEffectCount; ++e) {
            const auto effect = static_cast<Effect>(e);
            const std::size_t own = engine.effectBytes(effect);
            if (!engine.plan().on(effect)) {
                EXPECT_EQ(own, 0u) << effectName(effect);
            }
            bytes += own;
        }
        return bytes;
    };
    const std::size_t off = memoryOf(s);
    s.angularStiffness = 0.3f;
    s.sectionRatio = 0.6f;
    const std::size_t on = memoryOf(s);
    // 11 planes of bending and 6 of a flat section's twist in the one block, and whether the block twists.
    constexpr std::size_t kPlane = (12 * 32 + 16) * sizeof(float);
    EXPECT_EQ(on, off + 17 * kPlane + 1);
}

/// What the plan says of twist is what the kernel does: a flat section twists, straight or not.
TEST(EffectsOff, AFlatSectionTwists) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.02f, 12);
    SimulationSettings s;
    s.restGravity = 0.0f;
    s.sleepSpeed = 0.0f;
    Engine round = makeEngine(strands, s);
    EXPECT_EQ(round.plan().why(Effect::torsion), "torsion: off, hair is straight");
    EXPECT_EQ(round.effectBytes(Effect::torsion), 0u);
    s.sectionRatio = 0.6f;
    Engine flat = makeEngine(strands, s);
    EXPECT_EQ(flat.plan().why(Effect::torsion), "torsion: on, a flat section twists");
    EXPECT_GT(flat.effectBytes(Effect::torsion), 0u);
    const auto turnTo = [&](Engine& engine) {
        run(engine, strands, 20);
        return positionsOf(engine).back();
    };
    EXPECT_GT(length(turnTo(flat) - turnTo(round)), 1e-4f);
    s.angularStiffness = 0.0f;
    ASSERT_EQ(flat.setSettings(s), "");
    EXPECT_EQ(flat.plan().why(Effect::torsion), "torsion: off, no angular springs");
    EXPECT_EQ(flat.effectBytes(Effect::torsion), 0u);
}

/// A chain that is given stiffness goes on as a rod through its points, and the other way round.
TEST(EffectsOff, StiffnessComesAndGoesInMotion) {
    const Strands strands = tuft(20, true);
    SimulationSettings stiff, chain;
    stiff.sleepSpeed = chain.sleepSpeed = 0.0f;
    chain.angularStiffness = 0.0f;
    Engine engine = makeEngine(strands, chain);
    for (int turn = 0; turn < 4; ++turn) {
        run(engine, strands, 8);
        const std::vector<Float3> before = positionsOf(engine);
        std::vector<Float3> speeds(before.size()), after(before.size());
        engine.readVelocities(speeds);
        ASSERT_EQ(engine.setSettings(turn % 2 == 0 ? stiff : chain), "");
        engine.readVelocities(after);
        EXPECT_EQ(positionsOf(engine), before);
        EXPECT_EQ(after, speeds);
        run(engine, strands, 1);
        const auto measured = engine.measure();
        EXPECT_EQ(measured.nanCount, 0u);
        EXPECT_LT(measured.maxStretch, 1e-4);
        EXPECT_LT(measured.fastest, 30.0);
        EXPECT_EQ(engine.lastStep().restoredStrands, 0u);
    }
    EXPECT_EQ(engine.effectBytes(Effect::angular), 0u);
}

/// One Verlet step of zero acceleration keeps a strand's straight way: nothing else has touched it.
TEST(EffectsOff, AllOffFreePointsKeepTheirVelocity) {
    Strands strands;
    strands.add({}, {0.0f, -1.0f, 0.0f}, 0.05f, 3);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    s.gravity = {0.0f, 0.0f, 8.0f};
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 1);
    s.gravity = {};
    ASSERT_EQ(engine.setSettings(s), "");
    std::vector<Float3> speed(engine.pointCount());
    engine.readVelocities(speed);
    ASSERT_GT(speed[2].z, 0.1f);
    const Float3 before = positionsOf(engine)[2];
    run(engine, strands, 30);
    const Float3 after = positionsOf(engine)[2];
    EXPECT_NEAR(after.z, before.z + 0.5f * speed[2].z, 1e-5f);
    EXPECT_EQ(after.x, before.x);
    EXPECT_NEAR(after.y, before.y, 1e-7f);
}

}  // namespace
}  // namespace hairloom::runtime
