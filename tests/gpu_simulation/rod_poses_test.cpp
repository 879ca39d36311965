// SPDX-License-Identifier: GPL-3.0-or-later
// Rods that follow poses on the device, beside the engine on the CPU.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/stability/strand_set.h"
#include "hairloom/engine.h"
#include "tests/gpu_simulation/cpu_frame.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Effect;
using runtime::Float3;
using runtime::SimulationSettings;

constexpr float kFrame = 1.0f / 60.0f;

SimulationSettings rods() {
    SimulationSettings s;
    s.strandModel = runtime::StrandModel::rods;
    s.substeps = 4;
    s.windSpeed = 2.0f;
    s.angularStiffness = 0.5f;
    return s;
}

/// Curly strands of several lengths, 0.25 m.
StrandSet hair() {
    StrandSet strands;
    test::Dice dice(3);
    for (const std::uint32_t points : {2u, 3u, 5u, 16u, 33u, 16u, 9u}) {
        std::vector<Float3> strand{dice.inside(0.1f)};
        Float3 direction = dice.inside(1.0f) + Float3{0.0f, -1.5f, 0.0f};
        const float segment = 0.25f / static_cast<float>(points - 1);
        while (strand.size() < points) {
            direction = direction + dice.inside(4.0f * std::sqrt(segment));
            direction = direction * (1.0f / length(direction));
            strand.push_back(strand.back() + direction * segment);
        }
        strands.add(strand);
    }
    return strands;
}

/// Another shape of them, of two; the second is followed more towards the tip.
struct Poses {
    std::vector<Float3> swept, wet;
    std::vector<float> weights;
    std::vector<runtime::PoseView> views;

    explicit Poses(const StrandSet& strands) {
        const runtime::StrandsView view = strands.view();
        test::Dice dice(11);
        for (std::size_t s = 0; s + 1 < view.offsets.size(); ++s) {
            const runtime::Quat one = dice.turn(0.6f), other = dice.turn(0.6f);
            const Float3 root = view.restPositions_ss[view.offsets[s]];
            const auto last = static_cast<float>(view.offsets[s + 1] - view.offsets[s] - 1);
            for (std::uint32_t p = view.offsets[s]; p < view.offsets[s + 1]; ++p) {
                const Float3 at = view.restPositions_ss[p] - root;
                swept.push_back(root + rotate(one, at));
                wet.push_back(root + rotate(other, at));
                weights.push_back(static_cast<float>(p - view.offsets[s]) / last);
            }
        }
        views = {{swept, {}}, {wet, weights}};
    }
};

class RodPosesOnDevice : public GpuSimulationTest, public testing::WithParamInterface<LayoutOptions> {
  protected:
    struct Both {
        StrandEngine gpu;
        runtime::Engine cpu;

        Both(const StrandSet& strands, const SimulationSettings& settings, const EngineOptions& options)
            : gpu(engineOf(strands.view(), settings, options)),
              cpu(*runtime::Engine::make(strands.view(), settings).engine) {
            const Poses poses(strands);
            EXPECT_TRUE(gpu.setPoses(poses.views));
            EXPECT_EQ(cpu.setPoses(poses.views), "");
        }
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
        double farthest() { return RodPosesOnDevice::farthest(onGpu(), onCpu()); }
    };
    static double farthest(std::span<const Float3> a, std::span<const Float3> b) {
        double most = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const auto off = static_cast<double>(length(a[i] - b[i]));
            if (!(off <= most)) most = off;
        }
        return most;
    }
    /// A head that turns and walks, at frame `f`.
    static runtime::Vector<runtime::RootFrame> rootsAt(const StrandSet& strands, int f) {
        const float time = kFrame * static_cast<float>(f);
        const auto all =
            strands.roots({0.05f * time, 0.0f, 0.0f}, turnAboutY(0.3f * std::sin(6.2832f * time)));
        return {all.begin(), all.end()};
    }
};
INSTANTIATE_TEST_SUITE_P(Layouts, RodPosesOnDevice, testing::ValuesIn(kRodLayouts), [](const auto& layout) {
    return std::to_string(*layout.param.members) + "ThreadsAStrand";
});

/// As far as docs/gpu-simulation.md lets rods of gentle motion be off.
TEST_P(RodPosesOnDevice, AreFollowedAsOnTheCpu) {
    const StrandSet strands = hair();
    Both both(strands, rods(), options(GetParam()));
    std::vector<Float3> start = both.onCpu();
    double most = 0.0, way = 0.0;
    for (int f = 1; f <= 40; ++f) {
        // The first comes and goes, the second joins it, and both end in full.
        const float t = static_cast<float>(f) / 40.0f;
        const std::vector<float> amounts{f > 30 ? 1.0f : std::sin(3.1416f * t), f < 12 ? 0.0f : t};
        const auto roots = rootsAt(strands, f);
        runtime::FrameInput input;
        input.dt = kFrame;
        input.time = f * static_cast<double>(kFrame);
        input.roots_ws = roots;
        input.poseAmounts = amounts;
        both.step(input);
        most = std::max(most, both.farthest());
        way = std::max(way, farthest(both.onGpu(), start));
    }
    EXPECT_LE(most, 5e-5);
    EXPECT_GT(way, 0.05) << "else nothing is followed";
    EXPECT_TRUE(both.gpu.plan().on(Effect::pose));
    RecordProperty("farthest_nm", static_cast<int>(1e9 * most));
}

/// Poses inside a sphere leave hair on it.
TEST_P(RodPosesOnDevice, AreLessThanContacts) {
    const StrandSet strands = hair();
    SimulationSettings settings = rods();
    settings.windSpeed = 0.0f;
    Both both(strands, settings, options(GetParam()));
    const std::vector<runtime::Sphere> spheres{{{0.0f, -0.1f, 0.0f}, 0.06f}};
    const std::vector<float> amounts{1.0f, 1.0f};
    const auto roots = rootsAt(strands, 0);
    for (int f = 1; f <= 60; ++f) {
        runtime::FrameInput input;
        input.dt = kFrame;
        input.roots_ws = roots;
        input.spheres = spheres;
        input.poseAmounts = amounts;
        both.step(input);
    }
    const double gpu = both.gpu.measure().value().maxPenetration, cpu = both.cpu.measure().maxPenetration;
    EXPECT_LE(gpu, cpu + 1e-4);
    EXPECT_LE(both.farthest(), 1e-3);
}

TEST_P(RodPosesOnDevice, TakeNothingWhileTheirAmountsAreZero) {
    const StrandSet strands = hair();
    SimulationSettings settings = rods();
    settings.windSpeed = 0.0f;
    Both both(strands, settings, options(GetParam()));
    StrandEngine never = engineOf(strands.view(), settings, options(GetParam()));
    const auto frame = [&](int f, std::vector<float> amounts) {
        const auto roots = rootsAt(strands, f);
        runtime::FrameInput input;
        input.dt = kFrame;
        input.roots_ws = roots;
        ASSERT_TRUE(never.step(input));
        input.poseAmounts = amounts;
        both.step(input);
    };
    for (int f = 1; f <= 5; ++f) frame(f, {0.0f, 0.0f});
    EXPECT_FALSE(both.gpu.plan().on(Effect::pose));
    EXPECT_EQ(both.gpu.effectBytes(Effect::pose), 0u);
    EXPECT_EQ(both.gpu.stateHash().value(), never.stateHash().value()) << "bit for bit";
    frame(6, {0.5f, 0.0f});
    EXPECT_TRUE(both.gpu.plan().on(Effect::pose));
    EXPECT_GE(both.gpu.effectBytes(Effect::pose), std::size_t{32} * both.gpu.pointCount());
    EXPECT_NE(both.gpu.stateHash().value(), never.stateHash().value());
    frame(7, {0.0f, 0.0f});
    EXPECT_EQ(both.gpu.effectBytes(Effect::pose), 0u);
    EXPECT_LE(both.farthest(), 5e-5);
}

/// Hair that sleeps wakes; other settings lay poses anew.
TEST_P(RodPosesOnDevice, WakeHairAndTakeOtherSettings) {
    const StrandSet strands = hair();
    SimulationSettings settings = rods();
    settings.windSpeed = 0.0f;
    settings.sleepDelay = 0.1f;
    settings.dampingTime = 0.05f;
    Both both(strands, settings, options(GetParam()));
    const auto roots = rootsAt(strands, 0);
    runtime::FrameInput input;
    input.dt = kFrame;
    input.roots_ws = roots;
    for (int f = 0; f < 200; ++f) both.step(input);
    ASSERT_EQ(both.gpu.report().value().asleep, both.gpu.strandCount());
    const std::vector<Float3> before = both.onGpu();
    const std::vector<float> amounts{0.6f, 0.3f};
    EXPECT_TRUE(both.gpu.setPoseAmounts(amounts));
    EXPECT_TRUE(both.cpu.setPoseAmounts(amounts));
    EXPECT_FALSE(both.gpu.setPoseAmounts({amounts.data(), 1}));
    for (int f = 0; f < 20; ++f) both.step(input);
    EXPECT_GT(farthest(both.onGpu(), before), 0.02);
    EXPECT_LE(both.farthest(), 5e-5);
    settings.gravity.y *= 0.5f;
    ASSERT_TRUE(both.gpu.setSettings(settings));
    ASSERT_EQ(both.cpu.setSettings(settings), "");
    for (int f = 0; f < 20; ++f) both.step(input);
    EXPECT_LE(both.farthest(), 5e-5);
}

TEST_F(GpuSimulationTest, PosesOfOtherStrandsAreRefused) {
    const StrandSet strands = hair();
    StrandEngine engine = engineOf(strands.view(), rods(), options());
    const std::vector<Float3> few(3);
    const runtime::PoseView pose{few, {}};
    const auto refused = engine.setPoses({&pose, 1});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message().find("3 points"), std::string::npos);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
