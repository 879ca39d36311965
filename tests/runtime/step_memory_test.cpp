// SPDX-License-Identifier: GPL-3.0-or-later
// Steps ask for no memory, and a copy of an engine is a saved state of all of it.
#include "tests/runtime/allocations.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr float kFrame = 1.0f / 60.0f;
const std::vector<Sphere> kNear{{{0.1f, 0.02f, 0.0f}, 0.05f}, {{0.3f, 0.0f, 0.01f}, 0.07f}};
const std::vector<Sphere> kFar{{{90.0f, 0.0f, 0.0f}, 1.0f}, {{90.0f, 9.0f, 0.0f}, 1.0f}};

/// Steps with inputs that are made beforehand, so that only the engine can ask for memory.
class Counted {
  public:
    explicit Counted(const Strands& strands) {
        for (int f = 0; f < 40; ++f) {
            const float t = static_cast<float>(f);
            roots_.push_back(strands.roots({0.02f * std::sin(t), 0.0f, 0.0f},
                                           turnAbout({0.0f, 1.0f, 0.0f}, 0.3f * std::sin(0.4f * t))));
        }
    }
    /// Allocations of as many steps. `still` keeps the roots where they are.
    std::size_t steps(Engine& engine, int frames, std::span<const Sphere> spheres,
                      std::optional<Float3> wind = {}, bool still = false,
                      std::span<const Capsule> capsules = {}) {
        const std::size_t before = allocationCount();
        for (int f = 0; f < frames; ++f) {
            if (!still) ++frame_;
            time_ += static_cast<double>(kFrame);
            engine.step({kFrame, time_, roots_[frame_ % roots_.size()], spheres, capsules, wind});
        }
        return allocationCount() - before;
    }

  private:
    std::vector<std::vector<RootFrame>> roots_;
    std::size_t frame_ = 0;
    double time_ = 0.0;
};

SimulationSettings settingsOf(Integrator integrator) {
    SimulationSettings s = springSettings();
    s.integrator = integrator;
    s.angularStiffness = 0.02f;
    s.substeps = 12;
    s.windSpeed = 3.0f;
    return s;
}

TEST(StepMemory, NoStepOfAnyIntegratorAsksForAny) {
    const Strands strands = tuft(100, true);
    for (std::size_t i = 0; i < integratorNames().size(); ++i) {
        const auto integrator = static_cast<Integrator>(i);
        SCOPED_TRACE(nameOf(integrator));
        Engine engine = makeEngine(strands, settingsOf(integrator));
        Counted counted(strands);
        counted.steps(engine, 1, kNear);
        EXPECT_EQ(counted.steps(engine, 20, kNear), 0u);
        EXPECT_TRUE(engine.plan().on(Effect::collision));
        EXPECT_TRUE(engine.plan().on(Effect::wind));
    }
}

TEST(StepMemory, CapsulesThatGrowAskForNone) {
    for (const StrandModel model : {StrandModel::rods, StrandModel::springs}) {
        const Strands strands = tuft(100, true);
        SimulationSettings s = settingsOf(Integrator::verlet);
        s.strandModel = model;
        Engine engine = makeEngine(strands, s);
        Counted counted(strands);
        const std::vector<Capsule> capsules{{0, 1}};
        std::vector<Sphere> spheres{{{0.0f, -0.05f, -0.02f}, 0.02f}, {{0.05f, -0.05f, 0.02f}, 0.02f}};
        counted.steps(engine, 1, spheres, {}, false, capsules);
        EXPECT_TRUE(engine.plan().on(Effect::collision));
        for (int i = 0; i < 10; ++i) {
            spheres[1].center_ws.x += 0.05f;
            EXPECT_EQ(counted.steps(engine, 2, spheres, {}, false, capsules), 0u) << i;
        }
    }
}

TEST(StepMemory, HairAgainstHairAsksForNone) {
    const Strands strands = tuft(100, true);
    SimulationSettings s;
    s.hairHair = true;
    Engine engine = makeEngine(strands, s);
    Counted counted(strands);
    counted.steps(engine, 1, kNear);
    EXPECT_EQ(counted.steps(engine, 20, kNear), 0u);
    EXPECT_TRUE(engine.plan().on(Effect::hairHair));
}

TEST(StepMemory, TheCounterCounts) {
    const std::size_t before = allocationCount();
    const std::vector<int> some(3);
    EXPECT_EQ(some.size(), 3u);
    EXPECT_EQ(allocationCount() - before, 1u);
}

/// Wind given by frames, sweeps of fast heads, sleep.
TEST(StepMemory, EffectsJoinAndLeaveWithoutAny) {
    const Strands strands = tuft(100, true);
    SimulationSettings s = settingsOf(Integrator::verlet);
    s.windSpeed = 0.0f;
    s.dampingTime = 0.02f;
    s.sleepSpeed = 0.05f;
    s.sleepDelay = 0.1f;
    Engine engine = makeEngine(strands, s);
    Counted counted(strands);
    counted.steps(engine, 1, kNear);
    EXPECT_EQ(counted.steps(engine, 5, kNear, Float3{4.0f, 0.0f, 0.0f}), 0u);
    EXPECT_TRUE(engine.plan().on(Effect::wind));
    EXPECT_EQ(counted.steps(engine, 5, kNear), 0u);
    EXPECT_FALSE(engine.plan().on(Effect::wind));
    EXPECT_EQ(counted.steps(engine, 300, kNear, {}, true), 0u);
    EXPECT_EQ(engine.plan().reason(Effect::sleep), Reason::allAsleep) << engine.plan().why(Effect::sleep);
    EXPECT_EQ(counted.steps(engine, 5, kNear), 0u);
    EXPECT_FALSE(engine.plan().on(Effect::sleep));
}

TEST(StepMemory, CollisionLeavesAndJoins) {
    const Strands strands = tuft(100, true);
    Engine engine = makeEngine(strands, settingsOf(Integrator::verlet));
    Counted counted(strands);
    counted.steps(engine, 1, kNear);
    EXPECT_EQ(counted.steps(engine, 5, kFar), 0u);
    EXPECT_FALSE(engine.plan().on(Effect::collision));
    EXPECT_EQ(counted.steps(engine, 5, kNear), 0u);
    EXPECT_TRUE(engine.plan().on(Effect::collision));
}

/// Skin at y = 0 of two bones, one on each side, below hair that is level.
std::shared_ptr<const BodyField> floorOfTwoBones() {
    auto field = std::make_shared<BodyField>();
    field->low_ss = {-0.5f, -0.3f, -0.5f};
    field->cell = 0.1f;
    field->size = {10, 6, 10};
    field->unit = 1e-4f;
    for (std::uint32_t z = 0; z <= 10; ++z)
        for (std::uint32_t y = 0; y <= 6; ++y)
            for (std::uint32_t x = 0; x <= 10; ++x) {
                field->distances.push_back(static_cast<std::int16_t>(1000 * (static_cast<int>(y) - 3)));
                field->skins.push_back(static_cast<std::uint16_t>(x < 5 ? 0 : x == 5 ? 1 : 2));
            }
    field->palette = {
        {{0, 1, 0, 0}, {255, 0, 0, 0}}, {{0, 1, 0, 0}, {128, 127, 0, 0}}, {{0, 1, 0, 0}, {0, 255, 0, 0}}};
    field->blocks.assign(10 * 6 * 10, BodyField::kNoBlock);
    field->bones = {"left", "right"};
    field->boxes = {{{-0.6f, -0.4f, -0.6f}, {0.1f, 0.4f, 0.6f}}, {{-0.1f, -0.4f, -0.6f}, {0.6f, 0.4f, 0.6f}}};
    return field;
}

/// Bones apart and together, and frames so fast that they take more substeps.
TEST(StepMemory, ABodyTakesNone) {
    const Strands strands = tuft(100, true);
    SimulationSettings s;
    s.restGravity = 0.0f;
    Engine engine = makeEngine(strands, s);
    ASSERT_EQ(engine.setBody(floorOfTwoBones()), "");
    std::vector<std::vector<RootFrame>> roots;
    for (int f = 0; f < 40; ++f) {
        const float t = static_cast<float>(f);
        roots.push_back(strands.roots({(f > 20 ? 0.15f : 0.01f) * std::sin(t), 0.0f, 0.0f}));
    }
    std::uint32_t most = 0;
    const auto step = [&](std::size_t f) {
        std::array<BonePose, 2> bones{};
        bones[1].origin.y = f % 3 == 0 ? 0.0f : 0.01f;
        FrameInput input;
        input.dt = kFrame;
        input.time = static_cast<double>(kFrame) * static_cast<double>(f);
        input.roots_ws = roots[f];
        input.body_ws = bones;
        engine.step(input);
        most = std::max(most, engine.lastStep().substeps);
    };
    step(0);
    const std::size_t before = allocationCount();
    for (std::size_t f = 1; f < roots.size(); ++f) step(f);
    EXPECT_EQ(allocationCount(), before);
    EXPECT_EQ(most, 4 * s.substeps);
}

/// A copy taken in mid-run goes on as the original does, through sleep and wind.
TEST(SavedState, ResumesWithTheSameBits) {
    Strands strands = tuft(60, true);
    // Curls, so that there are frames to carry.
    for (std::size_t p = 0; p < strands.points.size(); ++p)
        strands.points[p].z += 0.004f * std::sin(1.3f * static_cast<float>(p));
    SimulationSettings s = springSettings();
    s.dampingTime = 0.02f;
    s.sleepSpeed = 0.05f;
    s.sleepDelay = 0.1f;
    s.windGustiness = 0.8f;
    Engine engine = makeEngine(strands, s);
    EXPECT_TRUE(engine.plan().on(Effect::torsion));
    // Three parts: a windy turn of the head, calm until asleep, and a gust that wakes all.
    struct Part {
        int frames;
        std::optional<Float3> wind;
        bool still;
    };
    const Part parts[] = {
        {20, Float3{5.0f, 0.0f, 1.0f}, false}, {300, {}, true}, {20, Float3{0.0f, 0.0f, 6.0f}, true}};
    Counted original(strands);
    bool slept = false;
    for (const Part& part : parts) {
        original.steps(engine, part.frames / 2, kNear, part.wind, part.still);
        const Engine saved = engine;
        const Counted here = original;
        slept = slept || saved.measure().asleep > 0;
        original.steps(engine, part.frames / 2, kNear, part.wind, part.still);
        const std::uint64_t end = engine.stateHash();
        const std::vector<Float3> positions = positionsOf(engine);
        const std::uint32_t asleep = engine.measure().asleep;
        engine = saved;
        original = here;
        original.steps(engine, part.frames / 2, kNear, part.wind, part.still);
        EXPECT_EQ(engine.stateHash(), end);
        EXPECT_EQ(positionsOf(engine), positions);
        EXPECT_EQ(engine.measure().asleep, asleep);
    }
    EXPECT_TRUE(slept) << "the save should hold strands at rest";
    EXPECT_EQ(engine.measure().nanCount, 0u);
}

}  // namespace
}  // namespace hairloom::runtime
