// SPDX-License-Identifier: GPL-3.0-or-later
// Rods and drawn hair against the baked skin of a body on the device, beside the CPU's.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/gpu_simulation/device_body.h"
#include "core/gpu_simulation/gpu_body_push.h"
#include "core/simulation/body_push.h"
#include "core/simulation/scene_input.h"
#include "hairloom/engine.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"
#include "tests/simulation/hairy_ball.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::BonePose;
using runtime::Float3;

constexpr float kFrame = 1.0f / 60;

/// Where the head and the bones of its body are.
struct Moment {
    HeadPose head;
    std::vector<BonePose> bones;
};
BonePose boneOf(const Eigen::Isometry3f& pose) {
    return toBonePose(Eigen::Affine3f(pose.matrix()));
}
Moment nodding(float time) {
    Moment at;
    at.head.head_ws = Eigen::Translation3f(0.1f * std::sin(3 * time), 0, 0) *
                      Eigen::AngleAxisf(0.6f * std::sin(6 * time), Vec3f::UnitX());
    at.bones = {boneOf(at.head.head_ws)};
    return at;
}
/// Of bentBall(): the lower half slides, the upper one turns on it.
Moment bending(float time) {
    const Eigen::Isometry3f base(Eigen::Translation3f(0.05f * std::sin(4 * time), 0, 0));
    Moment at;
    at.head.head_ws = base * Eigen::AngleAxisf(0.6f * std::sin(6 * time), Vec3f::UnitX());
    at.bones = {boneOf(base), boneOf(at.head.head_ws)};
    return at;
}
/// Starts at once and stops dead.
Moment dashing(float time) {
    Moment at;
    at.head.head_ws = Eigen::Translation3f(5 * std::min(time, 0.1f), 0, 0);
    at.bones = {boneOf(at.head.head_ws)};
    return at;
}

using Motion = Moment (*)(float);

/// Metres that points lie in the ball, but for the first two of each strand.
float depthInBall(std::span<const Float3> points, const HeadPose& head) {
    const Eigen::Isometry3f toBall = head.head_ws.inverse();
    float depth = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (p % test::kBallHairPoints < 2) continue;
        const Vec3f at = toBall * Vec3f(points[p].x, points[p].y, points[p].z);
        depth = std::max(depth, 0.1f - at.norm());
    }
    return depth;
}

double farthestOf(std::span<const Float3> a, std::span<const Float3> b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto off = static_cast<double>(length(a[i] - b[i]));
        if (!(off <= most)) most = off;
    }
    return most;
}

double meanOf(std::span<const Float3> a, std::span<const Float3> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(length(a[i] - b[i]));
    return sum / static_cast<double>(a.size());
}

class BodyOnGpu : public GpuSimulationTest {
  protected:
    void SetUp() override {
        GpuSimulationTest::SetUp();
        if (device() != nullptr && !hasBodyKernels(device()->info()))
            GTEST_SKIP() << "Direct3D 11 refuses a body, which BodyError tests";
    }
    struct Both {
        double farthest = 0, mean = 0;      ///< metres between the device's points and the CPU's, in the end
        float gpuDeepest = 0, deepest = 0;  ///< metres in the ball, of all frames
        std::uint64_t restored = 0;
    };
    static SceneInput scene() {
        auto made = SceneInput::make(test::hairyBody());
        if (!made) throw std::runtime_error(made.error().message());
        return std::move(*made);
    }
    static runtime::FrameInput inputAt(const SceneInput& scene, const Moment& at, float time,
                                       std::vector<runtime::RootFrame>& roots) {
        roots = scene.rootsAt(at.head);
        runtime::FrameInput input;
        input.dt = kFrame;
        input.time = static_cast<double>(time);
        input.roots_ws = roots;
        input.body_ws = at.bones;
        return input;
    }
    static EngineOptions beside(std::shared_ptr<const runtime::BodyField> body, const LayoutOptions& layout) {
        EngineOptions made = options(layout);
        // As hair that is drawn, whose kernel other tests make, too: this one takes long on a software
        // device.
        made.velocities = true;
        made.body = std::move(body);
        return made;
    }
    static Both run(const std::shared_ptr<const runtime::BodyField>& body, Motion motion, int frames,
                    const LayoutOptions& layout) {
        const SceneInput input = scene();
        const auto& settings = input.groom().simulation;
        StrandEngine gpu = engineOf(input.strands(), settings, beside(body, layout));
        auto cpu = std::move(*runtime::Engine::make(input.strands(), settings).engine);
        EXPECT_EQ(cpu.setBody(body), "");
        const auto start = input.rootsAt(motion(0).head);
        EXPECT_TRUE(gpu.reset(start));
        cpu.reset(start);
        Both both;
        std::vector<Float3> a(gpu.pointCount()), b(gpu.pointCount());
        std::vector<runtime::RootFrame> roots;
        for (int f = 1; f <= frames; ++f) {
            const float time = kFrame * static_cast<float>(f);
            const Moment at = motion(time);
            const runtime::FrameInput frame = inputAt(input, at, time, roots);
            const auto stepped = gpu.step(frame);
            EXPECT_TRUE(stepped) << stepped.error().message();
            cpu.step(frame);
            EXPECT_TRUE(gpu.readPositions(a));
            cpu.readPositions(b);
            both.gpuDeepest = std::max(both.gpuDeepest, depthInBall(a, at.head));
            both.deepest = std::max(both.deepest, depthInBall(b, at.head));
            both.restored += gpu.report()->restoredStrands;
        }
        both.farthest = farthestOf(a, b);
        both.mean = meanOf(a, b);
        return both;
    }
    /// How far the CPU's points come, at most and in the mean, from where they are if they begin some
    /// roundings off: hair that is about to slide off one side or the other is not sure of it.
    static Both spreadOnCpu(const std::shared_ptr<const runtime::BodyField>& body, Motion motion,
                            int frames) {
        const SceneInput input = scene();
        Both spread;
        std::vector<Float3> sure;
        for (std::uint64_t run = 0; run < 9; ++run) {
            Random random(run);
            runtime::StrandsView strands = input.strands();
            std::vector<Float3> rest(strands.restPositions_ss.begin(), strands.restPositions_ss.end());
            for (Float3& p : rest) {
                const Vec3f off = (run > 0 ? 1e-7f : 0.0f) * test::randomPoint(random, 1);
                p = p + Float3{off.x(), off.y(), off.z()};
            }
            strands.restPositions_ss = rest;
            auto cpu = std::move(*runtime::Engine::make(strands, input.groom().simulation).engine);
            EXPECT_EQ(cpu.setBody(body), "");
            cpu.reset(input.rootsAt(motion(0).head));
            std::vector<runtime::RootFrame> roots;
            for (int f = 1; f <= frames; ++f) {
                const float time = kFrame * static_cast<float>(f);
                cpu.step(inputAt(input, motion(time), time, roots));
            }
            std::vector<Float3> points(cpu.pointCount());
            cpu.readPositions(points);
            if (run == 0) sure = points;
            spread.farthest = std::max(spread.farthest, farthestOf(points, sure));
            spread.mean = std::max(spread.mean, meanOf(points, sure));
        }
        return spread;
    }
};

class BodyLayouts : public BodyOnGpu, public testing::WithParamInterface<LayoutOptions> {
  protected:
    void SetUp() override {
        BodyOnGpu::SetUp();
        if (IsSkipped()) return;
        if (GetParam().members != 1u && device()->info().type == gpu::DeviceType::Cpu)
            GTEST_SKIP() << "a software device compiles this kernel for minutes; run it on a GPU";
    }
};
INSTANTIATE_TEST_SUITE_P(Rods, BodyLayouts, testing::ValuesIn(kRodLayouts), [](const auto& layout) {
    return layout.param.members == 1u ? "OneThread" : "Shared";
});

TEST_P(BodyLayouts, RodsMeetTheSkinAsOnTheCpu) {
    const auto& body = test::hairyBody().body;
    const Both nod = run(body, nodding, 40, GetParam()), spread = spreadOnCpu(body, nodding, 40);
    EXPECT_LT(nod.farthest, 2 * spread.farthest);
    EXPECT_LT(nod.mean, 2 * spread.mean);
    EXPECT_NEAR(nod.gpuDeepest, nod.deepest, 1e-4f);
    EXPECT_LT(nod.gpuDeepest, 2e-3f) << "without skin it is 30 mm";
    EXPECT_EQ(nod.restored, 0u);
}

TEST_P(BodyLayouts, SkinBetweenTwoBonesIsFound) {
    const auto body = test::bentBall();
    const Both bent = run(body, bending, 30, GetParam());
    const Both spread = spreadOnCpu(body, bending, 30);
    EXPECT_LT(bent.farthest, 2 * spread.farthest);
    EXPECT_LT(bent.mean, 2 * spread.mean);
    EXPECT_NEAR(bent.gpuDeepest, bent.deepest, 1e-4f);
    EXPECT_EQ(bent.restored, 0u);
}

TEST_P(BodyLayouts, WhatAFastBodyRunsIntoIsSweptAlong) {
    const Both fast = run(test::hairyBody().body, dashing, 12, GetParam());
    EXPECT_LT(fast.gpuDeepest, 9e-3f) << "as on the CPU";
    EXPECT_LT(fast.gpuDeepest, fast.deepest + 1e-3f);
    EXPECT_EQ(fast.restored, 0u);
}

TEST_F(BodyOnGpu, AStateGoesOnWhereItWas) {
    const auto& body = test::hairyBody().body;
    const SceneInput input = scene();
    const auto make = [&] {
        StrandEngine made = engineOf(input.strands(), input.groom().simulation, beside(body, kRodLayouts[0]));
        EXPECT_TRUE(made.reset(input.rootsAt({})));
        return made;
    };
    StrandEngine whole = make();
    std::vector<runtime::RootFrame> roots;
    const auto step = [&](StrandEngine& engine, int from, int to) {
        for (int f = from; f <= to; ++f) {
            const float time = kFrame * static_cast<float>(f);
            const Moment at = nodding(time);
            ASSERT_TRUE(engine.step(inputAt(input, at, time, roots)));
        }
    };
    step(whole, 1, 30);
    const auto state = whole.readState();
    ASSERT_TRUE(state);
    EXPECT_EQ(state->body, (runtime::Vector<BonePose>{nodding(kFrame * 30).bones[0]}));
    const runtime::Floats& folds = state->own[4];
    EXPECT_TRUE(std::ranges::any_of(folds, [](float v) { return v != 0.0f; })) << "skin presses some";
    StrandEngine other = make();
    ASSERT_TRUE(other.writeState(*state));
    EXPECT_EQ(other.stateHash(), state->hash());
    step(whole, 31, 40);
    step(other, 31, 40);
    EXPECT_EQ(*whole.stateHash(), *other.stateHash());
}

TEST_F(BodyOnGpu, WithoutABodyNothingIsThere) {
    const SceneInput input = scene();
    auto settings = input.groom().simulation;
    const StrandEngine bare = engineOf(input.strands(), settings, options(kRodLayouts[0]));
    EXPECT_EQ(bare.bodyBytes(), 0u);
    EXPECT_EQ(bare.body(), nullptr);
    const auto key = keyFor(bare.plan(), settings, {.points = 12}, 0, false);
    EXPECT_NE(key.defines().find("#define HAIR_BODY 0"), std::string::npos);
    settings.strandModel = runtime::StrandModel::springs;
    const StrandEngine springs =
        engineOf(input.strands(), settings, beside(test::hairyBody().body, kHeldLayouts[0]));
    EXPECT_EQ(springs.bodyBytes(), 0u) << "springs pass through it";
}

TEST(BodyError, NamesTheDeviceWithoutSuchKernelsAndWhatToDo) {
    gpu::DeviceInfo info;
    info.backend = gpu::Backend::Direct3D11;
    runtime::SimulationSettings settings = test::hairyBody().simulation;
    const runtime::BodyField* const body = test::hairyBody().body.get();
    const std::string why = bodyError(info, settings, body);
    EXPECT_NE(why.find("Direct3D 11"), std::string::npos) << why;
    EXPECT_NE(why.find("Remove the skin collider"), std::string::npos) << why;
    EXPECT_EQ(bodyError(info, settings, nullptr), "");
    settings.strandModel = runtime::StrandModel::springs;
    EXPECT_EQ(bodyError(info, settings, body), "") << "springs pass through it";
    settings.strandModel = runtime::StrandModel::rods;
    info.backend = gpu::Backend::Vulkan;
    EXPECT_EQ(bodyError(info, settings, body), "");
}

/// What the device says where it has no such kernels, and at once: nothing passes through skin unseen.
TEST_F(GpuSimulationTest, AnEngineMeetsABodyOrRefusesIt) {
    auto scene = SceneInput::make(test::hairyBody());
    ASSERT_TRUE(scene);
    EngineOptions made = options(kRodLayouts[0]);
    made.velocities = true;
    made.body = test::hairyBody().body;
    const auto& settings = scene->groom().simulation;
    const auto engine = StrandEngine::make(*device(), library(), scene->strands(), settings, made);
    EXPECT_EQ(engine.has_value(), hasBodyKernels(device()->info()));
    if (engine) return;
    EXPECT_EQ(engine.error().message(), bodyError(device()->info(), settings, made.body.get()));
}

TEST_F(BodyOnGpu, AnotherModelMeetsTheSkinFromItsFirstFrameOn) {
    const SceneInput input = scene();
    const auto& body = test::hairyBody().body;
    auto springs = input.groom().simulation;
    springs.strandModel = runtime::StrandModel::springs;
    StrandEngine gpu = engineOf(input.strands(), springs, beside(body, kRodLayouts[0]));
    ASSERT_TRUE(gpu.reset(input.rootsAt({})));
    std::vector<runtime::RootFrame> roots;
    std::vector<Float3> points(gpu.pointCount());
    const auto step = [&](int from, int to) {
        for (int f = from; f <= to; ++f) {
            const Moment at = nodding(kFrame * static_cast<float>(f));
            ASSERT_TRUE(gpu.step(inputAt(input, at, kFrame * static_cast<float>(f), roots)));
        }
        ASSERT_TRUE(gpu.readPositions(points));
    };
    step(1, 3);
    EXPECT_EQ(gpu.body(), nullptr);
    ASSERT_TRUE(gpu.setSettings(input.groom().simulation));
    step(4, 45);
    EXPECT_NE(gpu.body(), nullptr);
    EXPECT_GT(gpu.bodyBytes(), body->bytes());
    EXPECT_LT(depthInBall(points, nodding(kFrame * 45).head), 1e-3f);
    ASSERT_TRUE(gpu.setSettings(springs));
    step(46, 47);
    EXPECT_EQ(gpu.body(), nullptr) << "springs pass through it";
    EXPECT_EQ(gpu.bodyBytes(), 0u);
}

/// Substeps are no multiple of the poses inside a frame: the skin goes as far through a piece as roots do.
TEST_F(BodyOnGpu, SkinGoesThroughAFrameAsRootsDo) {
    const SceneInput input = scene();
    const auto& body = test::hairyBody().body;
    StrandEngine gpu = engineOf(input.strands(), input.groom().simulation, beside(body, kRodLayouts[0]));
    auto cpu = std::move(*runtime::Engine::make(input.strands(), input.groom().simulation).engine);
    ASSERT_EQ(cpu.setBody(body), "");
    ASSERT_TRUE(gpu.reset(input.rootsAt({})));
    cpu.reset(input.rootsAt({}));
    constexpr float kLong = 1.0f / 24;
    std::vector<runtime::RootFrame> roots;
    std::vector<Float3> a(gpu.pointCount()), b(gpu.pointCount());
    for (int f = 1; f <= 4; ++f) {
        const float end = kLong * static_cast<float>(f);
        const Moment at = nodding(end);
        runtime::FrameInput frame = inputAt(input, at, end, roots);
        frame.dt = kLong;
        std::array<Moment, 3> within;
        std::array<std::vector<runtime::RootFrame>, 3> rootsWithin;
        std::vector<runtime::InnerPose> inner;
        for (std::size_t i = 0; i < within.size(); ++i) {
            within[i] = nodding(end - kLong * static_cast<float>(3 - i) / 4);
            rootsWithin[i] = input.rootsAt(within[i].head);
            inner.push_back({rootsWithin[i], {}, within[i].bones});
        }
        frame.inner = inner;
        ASSERT_TRUE(gpu.step(frame));
        cpu.step(frame);
    }
    ASSERT_TRUE(gpu.readPositions(a));
    cpu.readPositions(b);
    EXPECT_LT(meanOf(a, b), 2e-5);
}

TEST_F(BodyOnGpu, DrawnHairIsLedOutAsOnTheCpu) {
    const Groom& groom = test::hairyBody();
    const SceneInput input = scene();
    for (const Motion motion : {nodding, bending}) {
        const auto body = motion == bending ? test::bentBall() : groom.body;
        Groom posed = groom;
        posed.body = body;
        const auto push = makeBodyPush(posed, posed.offsets.view(), posed.positions());
        ASSERT_TRUE(push);
        StrandEngine engine =
            engineOf(input.strands(), input.groom().simulation, beside(body, kRodLayouts[0]));
        ASSERT_TRUE(engine.reset(input.rootsAt({})));
        // The body's pose is that of a frame's end.
        std::vector<runtime::RootFrame> roots;
        const float time = 0.2f;
        const Moment at = motion(time);
        ASSERT_TRUE(engine.step(inputAt(input, at, time, roots)));
        ASSERT_NE(engine.body(), nullptr);
        // Hair that hangs through the ball.
        std::vector<Float3> points;
        for (std::size_t s = 0; s + 1 < posed.offsets.view().size(); ++s) {
            const auto strand = posed.strand(s);
            for (std::size_t p = 0; p < strand.size(); ++p) {
                const Vec3f hung =
                    at.head.head_ws * strand[0] - 0.012f * static_cast<float>(p) * Vec3f::UnitY();
                points.push_back({hung.x(), hung.y(), hung.z()});
            }
        }
        // A point that is no number stays so.
        points[5].x = std::numeric_limits<float>::quiet_NaN();
        std::vector<shaders::float4> quads;
        for (const Float3& p : points) quads.push_back({p.x, p.y, p.z, 1});
        const auto buffer = makeBuffer<shaders::float4>(
            *device(), "drawn", gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess, quads.size(), quads);
        ASSERT_TRUE(buffer);
        const auto onGpu = GpuBodyPush::make(*device(), *push);
        ASSERT_TRUE(onGpu) << onGpu.error().message();
        auto list = device()->createCommandList();
        ASSERT_TRUE(list);
        onGpu->record(**list, *engine.body(), *buffer);
        const auto submission = device()->submit(std::move(*list));
        ASSERT_TRUE(submission);
        ASSERT_TRUE((*submission)->wait());
        ASSERT_TRUE(device()->readBuffer(*buffer, 0, std::as_writable_bytes(std::span(quads))));
        const std::vector<Float3> before = points;
        push->apply(at.bones, points);
        double farthest = 0, moved = 0;
        for (std::size_t p = 0; p < points.size(); ++p) {
            if (std::isnan(before[p].x)) continue;
            const Float3 there{quads[p].x, quads[p].y, quads[p].z};
            farthest = std::max(farthest, static_cast<double>(length(there - points[p])));
            moved = std::max(moved, static_cast<double>(length(points[p] - before[p])));
            EXPECT_EQ(quads[p].w, 1.0f);
        }
        EXPECT_GT(moved, 0.02) << "it was deep";
        EXPECT_LT(farthest, 1e-4);
        EXPECT_TRUE(std::isnan(quads[5].x));
    }
}

}  // namespace
}  // namespace hairloom::gpu_simulation
