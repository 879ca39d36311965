// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that follows poses: by how much, how fast, and what still wins.
#include <algorithm>
#include <limits>

#include "tests/runtime/allocations.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

SimulationSettings rods(std::uint32_t substeps = 4) {
    SimulationSettings s;
    s.strandModel = StrandModel::rods;
    s.substeps = substeps;
    s.sleepSpeed = 0.0f;
    return s;
}

/// The tuft's strands turned about their roots: far from the authored shape, of the same lengths.
std::vector<Float3> posedTuft(const Strands& strands, float angle = 1.1f) {
    const StrandsView view = strands.view();
    std::vector<Float3> posed(view.restPositions_ss.begin(), view.restPositions_ss.end());
    const Quat turn = turnAbout({0.0f, 0.0f, 1.0f}, angle);
    for (std::size_t s = 0; s + 1 < view.offsets.size(); ++s) {
        const Float3 root = view.restPositions_ss[view.offsets[s]];
        for (std::uint32_t p = view.offsets[s]; p < view.offsets[s + 1]; ++p)
            posed[p] = root + rotate(turn, posed[p] - root);
    }
    return posed;
}

/// Segments that the settings clamp follow the roots, not the pose: it goes on from there.
std::vector<Float3> heldPose(const Strands& strands, const std::vector<Float3>& posed,
                             std::uint32_t clamped) {
    const StrandsView view = strands.view();
    std::vector<Float3> held(view.restPositions_ss.begin(), view.restPositions_ss.end());
    for (std::size_t s = 0; s + 1 < view.offsets.size(); ++s) {
        for (std::uint32_t p = view.offsets[s] + clamped; p < view.offsets[s + 1]; ++p)
            held[p] = held[p - 1] + (posed[p] - posed[p - 1]);
    }
    return held;
}

Engine posedEngine(const Strands& strands, const SimulationSettings& settings,
                   const std::vector<Float3>& posed, float amount, std::span<const float> weights = {}) {
    Engine engine = makeEngine(strands, settings);
    const PoseView pose{posed, weights};
    EXPECT_EQ(engine.setPoses({&pose, 1}), "");
    EXPECT_TRUE(engine.setPoseAmounts({&amount, 1}));
    return engine;
}

float farthest(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    float most = 0.0f;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, length(a[i] - b[i]));
    return most;
}
float meanDistance(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(length(a[i] - b[i]));
    return static_cast<float>(sum / static_cast<double>(a.size()));
}

TEST(Pose, OffIsBitEqualToNone) {
    const Strands strands = tuft(20, true);
    Engine never = makeEngine(strands, rods());
    Engine off = posedEngine(strands, rods(), posedTuft(strands), 0.0f);
    run(never, strands, 20);
    run(off, strands, 20);
    EXPECT_EQ(never.stateHash(), off.stateHash());
    SimulationSettings slower = rods();
    slower.airDrag *= 2.0f;
    ASSERT_EQ(never.setSettings(slower), "");
    ASSERT_EQ(off.setSettings(slower), "");
    run(never, strands, 20);
    run(off, strands, 20);
    EXPECT_EQ(never.stateHash(), off.stateHash());
    EXPECT_EQ(never.baseBytes(), off.baseBytes());
    EXPECT_EQ(off.effectBytes(Effect::pose), 0u);
    EXPECT_EQ(never.plan().why(Effect::pose), "pose: off, no pose");
    EXPECT_EQ(off.plan().why(Effect::pose), "pose: off, zero amount");
}

TEST(Pose, GivenUpLeavesNoMemory) {
    const Strands strands = tuft(20, true);
    Engine engine = posedEngine(strands, rods(), posedTuft(strands), 0.7f);
    run(engine, strands, 3);
    EXPECT_EQ(engine.plan().why(Effect::pose), "pose: on, amount 0.7");
    EXPECT_GT(engine.effectBytes(Effect::pose), 0u);
    const float none = 0.0f;
    ASSERT_TRUE(engine.setPoseAmounts({&none, 1}));
    run(engine, strands, 1);
    EXPECT_EQ(engine.effectBytes(Effect::pose), 0u);
}

/// Laying them solves for the shapes that hang in them: what does not change these asks for none of it.
TEST(Pose, AreLaidAgainOnlyWhereTheirShapesChange) {
    const Strands strands = tuft(20, true);
    Engine none = makeEngine(strands, rods()), half = posedEngine(strands, rods(), posedTuft(strands), 0.5f);
    const auto asked = [](Engine& engine, const SimulationSettings& settings) {
        const std::size_t before = allocationCount();
        EXPECT_EQ(engine.setSettings(settings), "");
        return allocationCount() - before;
    };
    SimulationSettings windy = rods();
    windy.windSpeed = 2.0f;
    windy.airDrag *= 2.0f;
    EXPECT_EQ(asked(half, windy), asked(none, windy));
    SimulationSettings lighter = windy;
    lighter.gravity.y *= 0.5f;
    EXPECT_GT(asked(half, lighter), asked(none, lighter));
    // They are laid as those of an engine that was made with the settings.
    Engine made = posedEngine(strands, lighter, posedTuft(strands), 0.5f);
    run(half, strands, 300);
    run(made, strands, 300);
    EXPECT_LT(farthest(positionsOf(half), positionsOf(made)), 1e-4f);
}

/// Memory that is kept is there for poses that go and come.
TEST(Pose, WithKeptMemoryAsksForNone) {
    const Strands strands = tuft(20, true);
    Engine engine = posedEngine(strands, rods(), posedTuft(strands), 0.5f);
    engine.keepMemory();
    run(engine, strands, 2);
    const std::size_t before = allocationCount();
    for (const float amount : {0.0f, 0.3f, 0.0f, 1.0f}) {
        ASSERT_TRUE(engine.setPoseAmounts({&amount, 1}));
    }
    EXPECT_EQ(allocationCount() - before, 0u);
}

/// Hair of any stiffness, that carries its weight or not, on one clamped point or two.
TEST(Pose, AtOneHairStandsInIt) {
    const Strands strands = tuft(20, true);
    const std::vector<Float3> posed = posedTuft(strands);
    for (const float stiffness : {0.0f, 0.001f, 0.5f, 0.98f}) {
        for (const float held : {0.0f, 1.0f}) {
            for (const std::uint32_t clamped : {1u, 2u}) {
                SimulationSettings s = rods();
                s.angularStiffness = stiffness;
                s.restGravity = held;
                s.clampedPoints = clamped;
                Engine engine = posedEngine(strands, s, posed, 1.0f);
                run(engine, strands, 60);
                EXPECT_LT(farthest(positionsOf(engine), heldPose(strands, posed, clamped)), 1e-4f)
                    << stiffness << ' ' << held << ' ' << clamped;
            }
        }
    }
}

/// A half is between simulation and pose, of soft hair and of stiff hair.
TEST(Pose, AtAHalfHairIsBetween) {
    const Strands strands = tuft(20);
    const std::vector<Float3> posed = posedTuft(strands);
    for (const float stiffness : {0.1f, 0.5f, 0.98f}) {
        SimulationSettings s = rods();
        s.angularStiffness = stiffness;
        Engine none = makeEngine(strands, s), half = posedEngine(strands, s, posed, 0.5f);
        run(none, strands, 240);
        run(half, strands, 240);
        const std::vector<Float3> pose = heldPose(strands, posed, s.clampedPoints);
        const float whole = meanDistance(positionsOf(none), pose);
        const float left = meanDistance(positionsOf(half), pose);
        EXPECT_GT(left, 0.2f * whole) << stiffness;
        EXPECT_LT(left, 0.8f * whole) << stiffness;
    }
}

TEST(Pose, MoreAmountIsNearer) {
    const Strands strands = tuft(20);
    const std::vector<Float3> posed = posedTuft(strands);
    float last = std::numeric_limits<float>::max();
    for (const float amount : {0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
        Engine engine = posedEngine(strands, rods(), posed, amount);
        run(engine, strands, 240);
        const float left = meanDistance(positionsOf(engine), heldPose(strands, posed, 2));
        EXPECT_LT(left, last) << amount;
        last = left;
    }
}

/// The way there does not depend on how finely time is cut.
TEST(Pose, SubstepsAndFrameRatesAgree) {
    const Strands strands = tuft(12);
    const std::vector<Float3> posed = posedTuft(strands, 0.5f);
    const auto after = [&](float amount, std::uint32_t substeps, int rate, int tenths) {
        Engine engine = posedEngine(strands, rods(substeps), posed, amount);
        run(engine, strands, rate * tenths / 10, 1.0f / static_cast<float>(rate));
        return positionsOf(engine);
    };
    for (const float amount : {0.3f, 0.6f, 0.9f}) {
        const std::vector<Float3> fine = after(amount, 32, 60, 3);
        EXPECT_LT(farthest(after(amount, 8, 60, 3), fine), 3e-3f) << amount;
        EXPECT_LT(farthest(after(amount, 8, 30, 3), fine), 3e-3f) << amount;
        EXPECT_LT(farthest(after(amount, 8, 120, 3), fine), 3e-3f) << amount;
        EXPECT_LT(farthest(after(amount, 2, 60, 30), after(amount, 16, 60, 30)), 1e-3f) << amount;
    }
}

/// A head that turns and moves takes the pose along: no lag, nothing swings behind.
TEST(Pose, FollowsTheHead) {
    const Strands strands = tuft(12);
    SimulationSettings s = rods();
    const std::vector<Float3> posed = posedTuft(strands), pose = heldPose(strands, posed, s.clampedPoints);
    Engine engine = posedEngine(strands, s, posed, 1.0f);
    run(engine, strands, 30);
    float most = 0.0f;
    for (int f = 1; f <= 60; ++f) {
        const float t = static_cast<float>(f) / 60.0f;
        const Quat turn = turnAbout({0.0f, 1.0f, 0.0f}, 0.8f * std::sin(6.0f * t));
        const Float3 away{0.1f * std::sin(4.0f * t), 0.0f, 0.0f};
        std::vector<RootFrame> roots = strands.roots();
        for (RootFrame& root : roots) root = {rotate(turn, root.position) + away, turn * root.rotation};
        engine.step({1.0f / 60.0f, 1.0 + f / 60.0, roots});
        std::vector<Float3> carried(pose.size());
        for (std::size_t i = 0; i < pose.size(); ++i) carried[i] = rotate(turn, pose[i]) + away;
        most = std::max(most, farthest(positionsOf(engine), carried));
    }
    EXPECT_LT(most, 5e-4f);
}

TEST(Pose, ContactsWin) {
    Strands strands;
    for (std::uint32_t i = 0; i < 8; ++i)
        strands.add({0.002f * static_cast<float>(i), 0.1f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.01f, 16);
    const std::vector<Float3> posed = posedTuft(strands, 1.2f);
    const Sphere ball{{0.09f, 0.08f, 0.0f}, 0.05f};
    const auto deepestFrom = [&](std::uint32_t substeps, int from) {
        Engine engine = posedEngine(strands, rods(substeps), posed, 1.0f);
        float deepest = -1.0f;
        for (int f = 0; f < 120; ++f) {
            run(engine, strands, 1, 1.0f / 60.0f, {&ball, 1});
            for (const Float3 at : positionsOf(engine)) {
                if (f >= from) deepest = std::max(deepest, ball.radius - length(at - ball.center_ws));
            }
        }
        EXPECT_EQ(engine.measure().nanCount, 0u);
        return deepest;
    };
    // The pose goes through the ball.
    float inPose = 0.0f;
    for (const Float3 at : posed) inPose = std::max(inPose, ball.radius - length(at - ball.center_ws));
    EXPECT_GT(inPose, 0.02f);
    EXPECT_LT(deepestFrom(4, 20), 0.0f) << "at rest it keeps the collision radius";
    // As any hair that comes at the speed at which poses draw.
    EXPECT_LT(deepestFrom(8, 0), 0.0f) << "and on its way there";
}

TEST(Pose, WeightsSayWhere) {
    const Strands strands = tuft(20);
    const std::vector<Float3> posed = posedTuft(strands);
    std::vector<float> weights(posed.size(), 0.0f);
    std::fill(weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2), weights.end(), 1.0f);
    Engine none = makeEngine(strands, rods()), all = posedEngine(strands, rods(), posed, 1.0f);
    Engine some = posedEngine(strands, rods(), posed, 1.0f, weights);
    run(none, strands, 30);
    run(all, strands, 30);
    run(some, strands, 30);
    const auto half = [&](const Engine& engine, bool second) {
        const std::vector<Float3> at = positionsOf(engine);
        const auto middle = at.begin() + static_cast<std::ptrdiff_t>(at.size() / 2);
        return second ? std::vector<Float3>(middle, at.end()) : std::vector<Float3>(at.begin(), middle);
    };
    EXPECT_LT(farthest(half(some, false), half(none, false)), 1e-6f);
    EXPECT_LT(farthest(half(some, true), half(all, true)), 1e-6f);
}

TEST(Pose, TwoPosesMix) {
    const Strands strands = tuft(12);
    const std::vector<Float3> left = posedTuft(strands, 0.6f), right = posedTuft(strands, -0.6f);
    const PoseView both[] = {{left}, {right}};
    Engine engine = makeEngine(strands, rods());
    ASSERT_EQ(engine.setPoses(both), "");
    const auto stand = [&](float a, float b) {
        const float amounts[] = {a, b};
        EXPECT_TRUE(engine.setPoseAmounts(amounts));
        run(engine, strands, 60);
        return positionsOf(engine);
    };
    EXPECT_LT(farthest(stand(1.0f, 0.0f), heldPose(strands, left, 2)), 1e-4f);
    EXPECT_LT(farthest(stand(0.0f, 1.0f), heldPose(strands, right, 2)), 1e-4f);
    const std::vector<Float3> mixed = stand(1.0f, 1.0f);
    const float apart = meanDistance(heldPose(strands, left, 2), heldPose(strands, right, 2));
    EXPECT_LT(meanDistance(mixed, heldPose(strands, left, 2)), 0.7f * apart);
    EXPECT_LT(meanDistance(mixed, heldPose(strands, right, 2)), 0.7f * apart);
}

/// A pose that says nothing sound of the hair: folded into itself, turned over, in one point, thousands of
/// kilometres away.
TEST(Pose, HardCasesStaySound) {
    const Strands strands = tuft(20, true);
    const StrandsView view = strands.view();
    const std::vector<Float3> rest(view.restPositions_ss.begin(), view.restPositions_ss.end());
    std::vector<std::vector<Float3>> poses(4, rest);
    poses[0] = posedTuft(strands, 3.14159f);
    for (std::size_t p = 0; p < rest.size(); ++p) {
        const float f = static_cast<float>(p);
        poses[1][p] = p % 2 == 0 ? rest[p] : rest[p] * -1.0f;
        poses[2][p] = {1.0f, 2.0f, 3.0f};
        poses[3][p] = {9e5f * std::sin(f), 9e5f * std::cos(2.0f * f), -9e5f * std::cos(f)};
    }
    for (const std::vector<Float3>& posed : poses) {
        Engine engine = posedEngine(strands, rods(2), posed, 1.0f);
        const std::vector<RootFrame> roots = strands.roots();
        for (int f = 0; f < 90; ++f) {
            // On and off as fast as keys can.
            const float amount = f % 20 < 10 ? 1.0f : 0.01f;
            FrameInput frame{1.0f / 60.0f, f / 60.0, roots};
            frame.poseAmounts = {&amount, 1};
            engine.step(frame);
            EXPECT_EQ(engine.lastStep().restoredStrands, 0u);
        }
        const Measurements seen = engine.measure();
        EXPECT_EQ(seen.nanCount, 0u);
        EXPECT_LT(seen.maxStretch, 1e-4);
        EXPECT_LT(seen.fastest, 50.0);
        const float none = 0.0f;
        ASSERT_TRUE(engine.setPoseAmounts({&none, 1}));
        run(engine, strands, 240);
        EXPECT_LT(engine.measure().fastest, 2.0);
    }
}

/// In a pose that stays hair comes to rest, and an amount that changes wakes it up.
TEST(Pose, SleepsAndWakes) {
    const Strands strands = tuft(20);
    SimulationSettings s = rods();
    s.sleepSpeed = SimulationSettings().sleepSpeed;
    Engine engine = posedEngine(strands, s, posedTuft(strands), 0.8f);
    run(engine, strands, 600);
    EXPECT_EQ(engine.asleep(), engine.strandCount());
    const std::vector<Float3> before = positionsOf(engine);
    const float less = 0.1f;
    ASSERT_TRUE(engine.setPoseAmounts({&less, 1}));
    run(engine, strands, 60);
    EXPECT_GT(farthest(before, positionsOf(engine)), 0.005f);
}

TEST(Pose, CopiesAndThreadsHaveTheSameBits) {
    const Strands strands = tuft(100, true);
    Host backwards;
    backwards.parallelFor = [](std::size_t count, std::size_t grain, const auto& body) {
        for (std::size_t end = count; end > 0; end -= std::min(end, grain))
            body(end - std::min(end, grain), end);
    };
    Engine engine = posedEngine(strands, rods(), posedTuft(strands), 0.5f);
    Engine other = makeEngine(strands, rods(), backwards);
    const std::vector<Float3> posed = posedTuft(strands);
    const PoseView pose{posed};
    const float amount = 0.5f;
    ASSERT_EQ(other.setPoses({&pose, 1}), "");
    ASSERT_TRUE(other.setPoseAmounts({&amount, 1}));
    run(engine, strands, 10);
    run(other, strands, 10);
    EXPECT_EQ(engine.stateHash(), other.stateHash());
    Engine copy = engine;
    run(engine, strands, 10);
    run(copy, strands, 10);
    EXPECT_EQ(engine.stateHash(), copy.stateHash());
}

TEST(Pose, RefusesWhatIsNone) {
    const Strands strands = tuft(4);
    Engine engine = makeEngine(strands, rods());
    std::vector<Float3> posed = posedTuft(strands);
    std::vector<Float3> shorter(posed.begin(), posed.end() - 1);
    const PoseView few{shorter};
    EXPECT_EQ(engine.setPoses({&few, 1}), "pose 0 has 47 points; expected those of the strands, 48");
    posed[7].y = std::numeric_limits<float>::quiet_NaN();
    const PoseView broken{posed};
    EXPECT_EQ(engine.setPoses({&broken, 1}), "pose 0: point 7 is not a number within 1e6 m");
    posed = posedTuft(strands);
    std::vector<float> weights(posed.size(), 1.0f);
    weights[3] = 1.5f;
    const PoseView heavy{posed, weights};
    EXPECT_EQ(engine.setPoses({&heavy, 1}), "pose 0: the weight of point 3 is not within 0 … 1");
    const std::vector<PoseView> many(kMaxPoses + 1, PoseView{posed});
    EXPECT_EQ(engine.setPoses(many), "17 poses; expected at most 16");
    EXPECT_TRUE(engine.poseAmounts().empty());
    // What a frame says of amounts that are none is left out.
    const PoseView sound{posed};
    ASSERT_EQ(engine.setPoses({&sound, 1}), "");
    const std::vector<RootFrame> roots = strands.roots();
    const float amounts[] = {std::numeric_limits<float>::quiet_NaN(), 1.0f};
    FrameInput frame{1.0f / 60.0f, 0.0, roots};
    frame.poseAmounts = {amounts, 1};
    engine.step(frame);
    EXPECT_EQ(engine.poseAmounts()[0], 0.0f);
    frame.poseAmounts = amounts;
    engine.step(frame);
    EXPECT_EQ(engine.poseAmounts()[0], 0.0f);
    const float above = 7.0f;
    frame.poseAmounts = {&above, 1};
    engine.step(frame);
    EXPECT_EQ(engine.poseAmounts()[0], 1.0f);
}

TEST(Pose, SpringsFollowNone) {
    const Strands strands = tuft(4);
    SimulationSettings s = springSettings();
    Engine never = makeEngine(strands, s);
    Engine engine = posedEngine(strands, s, posedTuft(strands), 1.0f);
    run(never, strands, 5);
    run(engine, strands, 5);
    EXPECT_EQ(engine.plan().why(Effect::pose), "pose: off, springs follow no pose");
    EXPECT_EQ(engine.stateHash(), never.stateHash());
}

}  // namespace
}  // namespace hairloom::runtime
