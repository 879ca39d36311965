// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of the wrong size are refused, in release too, and nothing changes.
#include <array>

#include "hairloom/alternatives/hair_volume.h"
#include "hairloom/alternatives/lattice.h"
#include "hairloom/alternatives/projective_equations.h"
#include "tests/runtime/follow_fixture.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

TEST(Sizes, EngineRefusesArraysThatDoNotFit) {
    const Strands strands = tuft(5);
    Engine engine = makeEngine(strands, {});
    run(engine, strands, 3);
    const std::uint64_t before = engine.stateHash();
    for (const std::size_t roots : {0, 4, 6}) {
        const std::vector<RootFrame> wrong(roots);
        EXPECT_FALSE(engine.step({1.0f / 60.0f, 1.0, wrong}));
        EXPECT_FALSE(engine.reset(wrong));
    }
    for (const std::size_t points : {0u, engine.pointCount() - 1, engine.pointCount() + 1}) {
        std::vector<Float3> wrong(points, Float3{1.0f, 2.0f, 3.0f});
        EXPECT_FALSE(engine.addVelocities(wrong));
        EXPECT_FALSE(engine.readPositions(wrong));
        EXPECT_FALSE(engine.readVelocities(wrong));
        for (const Float3& value : wrong) EXPECT_EQ(value, (Float3{1.0f, 2.0f, 3.0f}));
    }
    EXPECT_EQ(engine.stateHash(), before);
    EXPECT_TRUE(engine.step({1.0f / 60.0f, 1.0, strands.roots()}));
    EXPECT_NE(engine.stateHash(), before);
}

TEST(Sizes, ACopyOfAnEngineRunsOnWithTheSameBits) {
    const Strands strands = tuft(40, true);
    Engine engine = makeEngine(strands, {});
    run(engine, strands, 2);
    Engine copy = engine;
    const std::uint64_t before = copy.stateHash();
    run(engine, strands, 5);
    EXPECT_EQ(copy.stateHash(), before);
    run(copy, strands, 5);
    EXPECT_EQ(copy.stateHash(), engine.stateHash());
}

TEST(Sizes, AlternativesRefuseArraysThatDoNotFit) {
    const Strands strands = tuft(5);
    ProjectiveEquations sticks = std::move(*ProjectiveEquations::make(strands.view(), {}).engine);
    Lattice lattice = std::move(*Lattice::make(strands.view(), {}).lattice);
    const std::vector<RootFrame> fewRoots(4);
    std::vector<Float3> few(sticks.pointCount() - 1), fewNodes(lattice.controlPointCount() - 1);
    EXPECT_FALSE(sticks.reset(fewRoots));
    EXPECT_FALSE(sticks.step({1.0f / 60.0f, 0.0, fewRoots}));
    EXPECT_FALSE(sticks.readPositions(few));
    EXPECT_FALSE(sticks.readVelocities(few));
    EXPECT_FALSE(lattice.evaluate(few));
    EXPECT_FALSE(lattice.readControlPoints(fewNodes));
    EXPECT_FALSE(lattice.setControlPoints(fewNodes));

    HairVolume volume = std::move(*HairVolume::make({}).volume);
    std::vector<Float3> velocities(strands.points.size() - 1, Float3{1.0f, 0.0f, 0.0f});
    EXPECT_EQ(volume.apply(strands.points, velocities, 0.01f).nodes, 0u);
    for (const Float3& velocity : velocities) EXPECT_EQ(velocity, (Float3{1.0f, 0.0f, 0.0f}));
}

TEST(Sizes, FollowHairsRefuseArraysThatDoNotFit) {
    const FollowScene scene = tangled(9);
    FollowHairs hairs = std::move(*FollowHairs::make(scene.view()).hairs);
    const GuideMotion motion{scene.positions, scene.velocities, scene.rotations};
    std::vector<Float3> out(scene.hairs() * 9), few(out.size() - 1);
    GuideMotion shortOf = motion;
    shortOf.positions_ws = shortOf.positions_ws.first(shortOf.positions_ws.size() - 1);
    EXPECT_FALSE(hairs.evaluate(shortOf, out));
    shortOf = motion;
    shortOf.velocities_ws = shortOf.velocities_ws.first(1);
    EXPECT_FALSE(hairs.evaluate(shortOf, out));
    shortOf = motion;
    shortOf.rootRotations_ws = shortOf.rootRotations_ws.first(1);
    EXPECT_FALSE(hairs.evaluate(shortOf, out));
    EXPECT_FALSE(hairs.evaluate(motion, few));
    EXPECT_TRUE(hairs.evaluate(motion, out));
}

}  // namespace
}  // namespace hairloom::runtime
