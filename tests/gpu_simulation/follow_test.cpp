// SPDX-License-Identifier: GPL-3.0-or-later
// Follow hairs on the device beside those of the runtime.
#include <algorithm>

#include "core/cost/benchmark_scenes.h"
#include "core/gpu_simulation/gpu_follow_hairs.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Float3;

class Follow : public GpuSimulationTest {
  protected:
    static gpu::BufferPtr quadsOf(std::span<const Float3> values) {
        std::vector<shaders::float4> quads;
        for (const Float3& v : values) quads.push_back({v.x, v.y, v.z, 1.0f});
        return makeBuffer<shaders::float4>(*device(), "guides", gpu::Usage::ShaderRead, quads.size(), quads)
            .value();
    }
    /// Greatest distance to the runtime's hairs, metres.
    static double distance(const runtime::FollowView& view, const runtime::GuideMotion& motion) {
        auto gpuHairs = GpuFollowHairs::make(*device(), view);
        if (!gpuHairs) throw std::runtime_error(gpuHairs.error().message());
        FollowInput input{quadsOf(motion.positions_ws), nullptr, motion.rootRotations_ws};
        if (!motion.velocities_ws.empty()) input.velocities_ws = quadsOf(motion.velocities_ws);
        auto list = device()->createCommandList().value();
        gpuHairs->record(*list, input);
        EXPECT_TRUE(device()->submit(std::move(list)).value()->wait());
        const std::size_t points = view.guides.size() * view.pointsPerHair;
        std::vector<shaders::float4> found(points);
        EXPECT_TRUE(
            device()->readBuffer(gpuHairs->positions_ws(), 0, std::as_writable_bytes(std::span(found))));
        std::vector<Float3> wanted(points);
        runtime::FollowHairs::make(view).hairs->evaluate(motion, wanted);
        double maximum = 0.0;
        for (std::size_t p = 0; p < points; ++p) {
            const Float3 position{found[p].x, found[p].y, found[p].z};
            maximum = std::max(maximum, static_cast<double>(length(position - wanted[p])));
            EXPECT_EQ(found[p].w, 1.0f);
        }
        return maximum;
    }
};

constexpr double kTolerance = 1e-6;  // metres: hairs of 0.2 m, some ten roundings

TEST_F(Follow, WispsTrianglesAndBlendsAreThoseOfTheRuntime) {
    for (const float blend : {0.0f, 0.4f, 1.0f}) {
        scenes::Lawn lawn(60, 5, 9, blend);
        for (std::size_t g = 0; g < lawn.rotations.size(); ++g)
            lawn.rotations[g] = {0.1f * static_cast<float>(g % 5), 0.3f, -0.2f, 0.9f};
        runtime::FollowView view = lawn.view();
        for (const float limit : {10.0f, 1.2f}) {
            view.wisps = {0.5f, limit};
            EXPECT_LE(distance(view, lawn.motion()), kTolerance) << blend << ", " << limit;
        }
    }
}

TEST_F(Follow, GuidesOfOtherPointCountsAreResampled) {
    scenes::Lawn lawn(40, 3, 12, 0.3f);
    runtime::FollowView view = lawn.view();
    view.pointsPerHair = 7;
    view.guideRestPositions_ss = lawn.positions;
    view.radii = std::span(lawn.radii).first(7);
    EXPECT_LE(distance(view, lawn.motion()), kTolerance);
}

TEST_F(Follow, GuidesAtRestOrWithoutLengthAreFollowed) {
    scenes::Lawn lawn(40, 3, 6, 0.2f);
    for (std::size_t p = 0; p < 12; ++p) lawn.positions[p] = lawn.positions[p / 6 * 6];
    for (std::size_t p = 12; p < 18; ++p) lawn.positions[p].y = p % 2 == 0 ? 0.1f : 0.0f;  // folded
    runtime::GuideMotion motion = lawn.motion();
    motion.velocities_ws = {};
    EXPECT_LE(distance(lawn.view(), motion), kTolerance);
}

TEST_F(Follow, EnginePositionsAreUsed) {
    const scenes::Lawn lawn(40, 3, 6, 0.5f);
    EngineOptions engineOptions = options();
    engineOptions.velocities = true;
    StrandEngine engine = engineOf({lawn.offsets, lawn.positions}, {}, engineOptions);
    std::vector<runtime::RootFrame> roots;
    for (std::size_t g = 0; g < lawn.rotations.size(); ++g) roots.push_back({lawn.positions[6 * g], {}});
    for (int f = 0; f < 3; ++f) ASSERT_TRUE(engine.step({1.0f / 60.0f, 0.0, roots, {}}));
    auto hairs = GpuFollowHairs::make(*device(), lawn.view());
    ASSERT_TRUE(hairs);
    auto list = device()->createCommandList().value();
    hairs->record(*list, {engine.positions_ws(), engine.velocities_ws(), {}});
    ASSERT_TRUE(device()->submit(std::move(list)).value()->wait());
    std::vector<Float3> positions(engine.pointCount()), velocities(positions), wanted(lawn.hairPointCount());
    ASSERT_TRUE(engine.readPositions(positions));
    ASSERT_TRUE(engine.readVelocities(velocities));
    runtime::FollowHairs::make(lawn.view()).hairs->evaluate({positions, velocities, {}}, wanted);
    std::vector<shaders::float4> found(wanted.size());
    ASSERT_TRUE(device()->readBuffer(hairs->positions_ws(), 0, std::as_writable_bytes(std::span(found))));
    for (std::size_t p = 0; p < wanted.size(); ++p) {
        EXPECT_NEAR(found[p].x, wanted[p].x, 1e-5f);
        EXPECT_NEAR(found[p].y, wanted[p].y, 1e-5f);
        EXPECT_NEAR(found[p].z, wanted[p].z, 1e-5f);
    }
}

}  // namespace
}  // namespace hairloom::gpu_simulation
