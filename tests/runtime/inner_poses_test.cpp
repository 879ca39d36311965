// SPDX-License-Identifier: GPL-3.0-or-later
// Poses within a frame: substeps see the motion through them.
#include "tests/runtime/allocations.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

constexpr float kFrame = 1.0f / 30.0f;

/// Everything that moves, at a time; `seconds` may be any.
struct Scene {
    std::vector<RootFrame> roots;
    std::vector<Sphere> spheres;
    std::vector<BonePose> bones;

    InnerPose pose() const { return {roots, spheres, bones}; }
};

/// A head that nods and shakes about a pivot below the roots, with spheres on it.
Scene nodding(const Strands& strands, float seconds, bool withSpheres) {
    const float angle = 0.5f * std::sin(8.0f * seconds);
    const Quat turn = turnAbout({0.6f, 0.0f, 0.8f}, angle);
    const Float3 pivot{0.1f, -0.1f, 0.0f};
    const Float3 shift{0.05f * std::sin(11.0f * seconds), 0.02f * std::sin(7.0f * seconds), 0.0f};
    const auto moved = [&](Float3 at) { return pivot + shift + rotate(turn, at - pivot); };
    Scene scene;
    for (const RootFrame& root : strands.roots()) scene.roots.push_back({moved(root.position), turn});
    if (withSpheres) {
        scene.spheres = {{moved({0.1f, 0.02f, 0.0f}), 0.05f},
                         {moved({0.3f, 0.0f, 0.01f}), 0.06f},
                         {moved({0.2f, -0.06f, -0.05f}), 0.03f}};
    }
    const auto axis = [&](Float3 a) { return rotate(turn, a); };
    scene.bones = {{axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1}), moved({})}};
    return scene;
}

/// A box of skin that bones move, below the roots.
std::shared_ptr<const BodyField> box() {
    auto field = std::make_shared<BodyField>();
    field->low_ss = {-0.5f, -0.3f, -0.5f};
    field->cell = 0.1f;
    field->size = {10, 6, 10};
    field->unit = 1e-4f;
    for (std::uint32_t z = 0; z <= 10; ++z)
        for (std::uint32_t y = 0; y <= 6; ++y)
            for (std::uint32_t x = 0; x <= 10; ++x) {
                field->distances.push_back(static_cast<std::int16_t>(1000 * (static_cast<int>(y) - 3)));
                field->skins.push_back(0);
            }
    field->palette = {{{0, 0, 0, 0}, {255, 0, 0, 0}}};
    field->blocks.assign(10 * 6 * 10, BodyField::kNoBlock);
    field->bones = {"head"};
    field->boxes = {{{-0.6f, -0.4f, -0.6f}, {0.6f, 0.4f, 0.6f}}};
    return field;
}

struct Case {
    const char* name;
    SimulationSettings settings;
    bool spheres = false, capsules = false, body = false;
};

SimulationSettings rods(std::uint32_t substeps) {
    SimulationSettings s;
    s.substeps = substeps;
    return s;
}

std::vector<Case> cases() {
    std::vector<Case> all{{"rods", rods(2)}, {"rods among spheres", rods(4), true}};
    all.push_back({"rods and capsules in wind", rods(2), true, true});
    all.back().settings.windSpeed = 4.0f;
    all.back().settings.windGustiness = 0.6f;
    all.push_back({"rods and a body", rods(2), false, false, true});
    all.push_back({"rods against rods", rods(2), true});
    all.back().settings.hairHair = true;
    all.push_back({"springs", springSettings(), true});
    all.back().settings.substeps = 8;
    all.back().settings.windSpeed = 3.0f;
    all.push_back({"springs, implicitly", springSettings(), true, true});
    all.back().settings.substeps = 4;
    all.back().settings.integrator = Integrator::implicitEuler;
    return all;
}

const std::vector<Capsule> kCapsules{{0, 1}, {1, 2}};

/// A frame that ends at `seconds`, and the poses at `inner` equal shares before it.
class Frame {
  public:
    Frame(const Strands& strands, double seconds, float dt, std::size_t inner, const Case& how)
        : end_(nodding(strands, static_cast<float>(seconds), how.spheres)) {
        for (std::size_t i = 1; i <= inner; ++i) {
            const double left = static_cast<double>(inner + 1 - i) / static_cast<double>(inner + 1);
            scenes_.push_back(
                nodding(strands, static_cast<float>(seconds - static_cast<double>(dt) * left), how.spheres));
        }
        for (const Scene& scene : scenes_) poses_.push_back(scene.pose());
        input_.dt = dt;
        input_.time = seconds;
        input_.roots_ws = end_.roots;
        input_.spheres = end_.spheres;
        if (how.capsules) input_.capsules = kCapsules;
        input_.body_ws = end_.bones;
        input_.inner = poses_;
    }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    operator const FrameInput&() const { return input_; }  // NOLINT(google-explicit-constructor)
    FrameInput& input() { return input_; }
    std::vector<Scene>& scenes() { return scenes_; }

  private:
    Scene end_;
    std::vector<Scene> scenes_;
    std::vector<InnerPose> poses_;
    FrameInput input_;
};

Engine engineOf(const Strands& strands, const Case& how) {
    Engine engine = makeEngine(strands, how.settings);
    if (how.body) {
        EXPECT_EQ(engine.setBody(box()), "");
    }
    engine.reset(nodding(strands, 0.0f, false).roots);
    return engine;
}

double farthest(const Engine& a, const Engine& b) {
    const auto one = positionsOf(a), other = positionsOf(b);
    double most = 0.0;
    for (std::size_t p = 0; p < one.size(); ++p)
        most = std::max(most, static_cast<double>(length(one[p] - other[p])));
    return most;
}

TEST(InnerPoses, AFrameOfQuartersIsItsFourQuarterFrames) {
    const Strands strands = tuft(70, true);
    for (const Case& how : cases()) {
        SCOPED_TRACE(how.name);
        Engine whole = engineOf(strands, how), quarters = engineOf(strands, how);
        for (int f = 1; f <= 40; ++f) {
            const double time = f * static_cast<double>(kFrame);
            whole.step(Frame(strands, time, kFrame, 3, how));
            for (int q = 3; q >= 0; --q) {
                const double now = time - static_cast<double>(kFrame) * (q / 4.0);
                quarters.step(Frame(strands, now, kFrame / 4.0f, 0, how));
            }
            ASSERT_EQ(whole.stateHash(), quarters.stateHash())
                << "frame " << f << ", off by " << 1e3 * farthest(whole, quarters) << " mm";
        }
        EXPECT_GE(whole.lastStep().substeps, how.settings.substeps * 2);
        EXPECT_LT(whole.measure().maxStretch, 0.2);
        if (how.spheres) {
            EXPECT_TRUE(whole.plan().on(Effect::collision));
        }
    }
}

TEST(InnerPoses, QuartersOfAFrameOfTwoSubstepsAreItsHalves) {
    const Strands strands = tuft(40, true);
    const Case how{"rods", rods(2), true};
    Engine quarters = engineOf(strands, how), halves = engineOf(strands, how);
    for (int f = 1; f <= 40; ++f) {
        const double time = f / 60.0;
        quarters.step(Frame(strands, time, 1.0f / 60.0f, 3, how));
        halves.step(Frame(strands, time, 1.0f / 60.0f, 1, how));
        ASSERT_EQ(quarters.lastStep().substeps, 2u);
        ASSERT_EQ(quarters.stateHash(), halves.stateHash()) << "frame " << f;
    }
}

/// A frame of 1/24 s has five substeps, none of which ends at a quarter.
TEST(InnerPoses, SubstepsGoStraightFromPoseToPose) {
    const Strands strands = tuft(40, true);
    const Case how{"rods", rods(2), true};
    Engine whole = engineOf(strands, how), parts = engineOf(strands, how);
    const float dt = 1.0f / 24.0f;
    const auto mixed = [](const Scene& a, const Scene& b, float t) {
        Scene scene = b;
        const auto mix = [&](float x, float y) { return x + (y - x) * t; };
        const auto mix3 = [&](Float3 x, Float3 y) { return x + (y - x) * t; };
        for (std::size_t i = 0; i < a.roots.size(); ++i) {
            const Quat p = a.roots[i].rotation, q = b.roots[i].rotation;
            scene.roots[i] = {mix3(a.roots[i].position, b.roots[i].position),
                              {mix(p.x, q.x), mix(p.y, q.y), mix(p.z, q.z), mix(p.w, q.w)}};
            normalize(scene.roots[i].rotation);
        }
        for (std::size_t i = 0; i < a.spheres.size(); ++i)
            scene.spheres[i].center_ws = mix3(a.spheres[i].center_ws, b.spheres[i].center_ws);
        return scene;
    };
    // Spheres are known from the first frame on.
    for (Engine* engine : {&whole, &parts}) engine->step(Frame(strands, 0.0, 1.0f / 120.0f, 0, how));
    for (int f = 1; f <= 24; ++f) {
        const double start = (f - 1) / 24.0;
        whole.step(Frame(strands, f / 24.0, dt, 3, how));
        ASSERT_EQ(whole.lastStep().substeps, 5u);
        for (int i = 1; i <= 5; ++i) {
            const float quarters = 4.0f * static_cast<float>(i) / 5.0f, first = std::ceil(quarters) - 1.0f;
            const auto at = [&](float q) {
                return nodding(strands, static_cast<float>(start + static_cast<double>(dt) * q / 4.0), true);
            };
            const Scene scene = mixed(at(first), at(first + 1.0f), quarters - first);
            parts.step({dt / 5.0f, start + static_cast<double>(dt) * i / 5.0, scene.roots, scene.spheres});
        }
        // What the hair makes of rounding grows.
        ASSERT_LT(farthest(whole, parts), f < 5 ? 1e-6 : 2e-4) << "frame " << f;
    }
}

/// Engines with and without that number of poses inside go straight on: metres that they get apart.
double apartOnAStraightWay(std::uint32_t substeps, std::size_t inner, bool hasSphere) {
    const Strands strands = tuft(40, true);
    Engine with = makeEngine(strands, rods(substeps)), without = makeEngine(strands, rods(substeps));
    double most = 0.0;
    // A sphere has no speed in its first frame, nor has a pose inside that.
    for (int f = 0; f <= (hasSphere ? 5 : 20); ++f) {
        const float now = static_cast<float>(f), way = 0.04f;
        std::vector<Sphere> spheres;
        if (hasSphere) spheres = {{{0.1f + way * now, 0.02f, 0.0f}, 0.05f}};
        const std::vector<RootFrame> roots = strands.roots({way * now, 0.0f, 0.0f});
        FrameInput input{1.0f / 60.0f, now / 60.0, roots, spheres};
        without.step(input);
        std::vector<std::vector<RootFrame>> rootsInside(inner);
        std::vector<std::vector<Sphere>> spheresInside(inner, spheres);
        std::vector<InnerPose> poses;
        for (std::size_t i = 0; i < inner; ++i) {
            const float back = way * (1.0f - static_cast<float>(i + 1) / static_cast<float>(inner + 1));
            rootsInside[i] = strands.roots({way * now - back, 0.0f, 0.0f});
            for (Sphere& sphere : spheresInside[i]) sphere.center_ws.x -= back;
            poses.push_back({rootsInside[i], spheresInside[i]});
        }
        if (f > 0) input.inner = poses;
        with.step(input);
        EXPECT_EQ(with.lastStep().substeps, without.lastStep().substeps);
        most = std::max(most, farthest(with, without));
    }
    return most;
}

TEST(InnerPoses, OnAStraightWayTheyChangeNothing) {
    for (const std::uint32_t substeps : {1u, 2u, 3u, 5u, 8u}) {
        for (const std::size_t inner : {std::size_t{1}, std::size_t{3}, kMaxInnerPoses}) {
            SCOPED_TRACE(testing::Message() << substeps << " substeps, " << inner << " poses");
            EXPECT_LT(apartOnAStraightWay(substeps, inner, false), 2e-5);
            // Contacts make more of rounding, frame by frame.
            EXPECT_LT(apartOnAStraightWay(substeps, inner, true), 2e-4);
        }
    }
}

/// Against the head at 240 Hz: what sampling it 30 times a second loses.
TEST(InnerPoses, QuartersLeaveLittleOfWhatFramesMiss) {
    const Strands strands = tuft(70, true);
    const Case how{"rods", rods(8)};
    Engine truth = engineOf(strands, how), ends = engineOf(strands, how), quarters = engineOf(strands, how);
    double lost = 0.0, left = 0.0;
    for (int f = 1; f <= 60; ++f) {
        const double time = f * static_cast<double>(kFrame);
        truth.step(Frame(strands, time, kFrame, 7, how));
        ends.step(Frame(strands, time, kFrame, 0, how));
        quarters.step(Frame(strands, time, kFrame, 3, how));
        lost = std::max(lost, farthest(truth, ends));
        left = std::max(left, farthest(truth, quarters));
    }
    EXPECT_GT(lost, 2e-3);
    EXPECT_LT(left, lost / 6);
}

TEST(InnerPoses, ACutTakesTheHairAlong) {
    const Strands strands = tuft(40, true);
    for (const Case& how : cases()) {
        if (how.body || how.settings.windSpeed > 0.0f || how.settings.hairHair) continue;
        SCOPED_TRACE(how.name);
        Engine moved = engineOf(strands, how);
        for (int f = 1; f <= 20; ++f) moved.step(Frame(strands, f / 60.0, 1.0f / 60.0f, 3, how));
        const Scene here = nodding(strands, 20.0f / 60.0f, how.spheres);
        Scene there = here;
        // Less than teleportDistance.
        const Float3 way{0.5f, 0.0f, 0.0f};
        for (RootFrame& root : there.roots) root.position = root.position + way;
        for (Sphere& sphere : there.spheres) sphere.center_ws = sphere.center_ws + way;
        for (const bool inside : {false, true}) {
            const auto after = [&](const Scene& scene, bool cut) {
                const std::vector<InnerPose> poses(inside ? 3 : 0, scene.pose());
                FrameInput input{1.0f / 60.0f, 21.0 / 60.0, scene.roots, scene.spheres};
                if (how.capsules) input.capsules = kCapsules;
                input.inner = poses;
                input.cut = cut;
                Engine engine = moved;
                engine.step(input);
                return positionsOf(engine);
            };
            const auto still = after(here, false), jumped = after(there, true), swept = after(there, false);
            double most = 0.0, mostSwept = 0.0;
            for (std::size_t p = 0; p < still.size(); ++p) {
                most = std::max(most, static_cast<double>(length(jumped[p] - way - still[p])));
                mostSwept = std::max(mostSwept, static_cast<double>(length(swept[p] - way - still[p])));
            }
            EXPECT_LT(most, 1e-4) << inside;
            EXPECT_GT(mostSwept, 0.01) << "without a cut";
        }
    }
}

/// Roots go from the first pose of a cut to the next ones, not from where they were.
TEST(InnerPoses, ACutBeginsAtTheFirstPose) {
    const Strands strands = tuft(20, true);
    const Case how{"rods", rods(2)};
    Engine cut = engineOf(strands, how), parts = engineOf(strands, how);
    Frame first(strands, 1.0 + static_cast<double>(kFrame), kFrame, 3, how);
    first.input().cut = true;
    cut.step(first);
    for (int q = 3; q >= 0; --q) {
        Frame part(strands, 1.0 + static_cast<double>(kFrame) * (4 - q) / 4.0, kFrame / 4.0f, 0, how);
        part.input().cut = q == 3;
        parts.step(part);
    }
    EXPECT_LT(farthest(cut, parts), 1e-6);
}

TEST(InnerPoses, SleepersWakeByMotionInsideAlone) {
    const Strands strands = tuft(40);
    SimulationSettings s = rods(2);
    s.sleepDelay = 0.1f;
    Engine engine = makeEngine(strands, s);
    const std::vector<RootFrame> roots = strands.roots(), aside = strands.roots({0.01f, 0.0f, 0.0f});
    const std::vector<InnerPose> still(3, InnerPose{roots});
    const std::vector<InnerPose> sway{{roots}, {aside}, {roots}};
    FrameInput input{kFrame, 0.0, roots};
    input.inner = still;
    for (int f = 0; f < 400 && engine.asleep() < engine.strandCount(); ++f) engine.step(input);
    ASSERT_EQ(engine.asleep(), engine.strandCount());
    const std::uint64_t asleep = engine.stateHash();
    engine.step(input);
    EXPECT_EQ(engine.stateHash(), asleep);
    input.inner = sway;
    engine.step(input);
    EXPECT_EQ(engine.asleep(), 0u);
    EXPECT_NE(engine.stateHash(), asleep);
}

TEST(InnerPoses, WrongOnesAreRefusedOrLeftOut) {
    const Strands strands = tuft(20, true);
    const Case how{"rods", rods(2), true, false, true};
    Engine engine = engineOf(strands, how);
    engine.step(Frame(strands, 1.0 / 30.0, kFrame, 3, how));
    const std::uint64_t before = engine.stateHash();
    Frame bad(strands, 2.0 / 30.0, kFrame, 3, how);
    std::vector<InnerPose> poses(kMaxInnerPoses + 1, bad.scenes()[0].pose());
    FrameInput input = bad;
    input.inner = poses;
    EXPECT_FALSE(engine.step(input)) << "too many";
    poses.resize(2);
    poses[1].roots_ws = poses[1].roots_ws.first(3);
    input.inner = poses;
    EXPECT_FALSE(engine.step(input)) << "roots of others";
    EXPECT_EQ(engine.stateHash(), before);
    // One root and one sphere that are none, for a quarter; another number of spheres in one pose.
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const bool fewer : {false, true}) {
        Frame frame(strands, 2.0 / 30.0, kFrame, 3, how);
        frame.scenes()[1].roots[2].position.x = kNan;
        frame.scenes()[1].spheres[0].center_ws.y = kNan;
        frame.scenes()[2].bones[0].x.x = kNan;
        std::vector<InnerPose> given;
        for (const Scene& scene : frame.scenes()) given.push_back(scene.pose());
        if (fewer) given[0].spheres = given[0].spheres.first(1);
        frame.input().inner = given;
        Engine another = engine;
        EXPECT_TRUE(another.step(frame));
        EXPECT_EQ(another.lastStep().rejectedRoots, 1u);
        EXPECT_EQ(another.lastStep().rejectedSpheres, fewer ? 0u : 1u) << "others go straight";
        EXPECT_EQ(another.measure().nanCount, 0u);
        EXPECT_EQ(another.lastStep().restoredStrands, 0u);
    }
}

TEST(InnerPoses, AskForNoMemory) {
    const Strands strands = tuft(100, true);
    for (const Case& how : cases()) {
        SCOPED_TRACE(how.name);
        Engine engine = engineOf(strands, how);
        // 1/24 s: pieces begin between poses.
        engine.step(Frame(strands, 1.0 / 24.0, 1.0f / 24.0f, 3, how));
        engine.step(Frame(strands, 2.0 / 24.0, 1.0f / 24.0f, 0, how));
        std::size_t asked = 0;
        for (int f = 3; f < 13; ++f) {
            const Frame frame(strands, f / 24.0, 1.0f / 24.0f, 3, how);
            const std::size_t before = allocationCount();
            engine.step(frame);
            asked += allocationCount() - before;
        }
        EXPECT_EQ(asked, 0u);
    }
}

}  // namespace
}  // namespace hairloom::runtime
