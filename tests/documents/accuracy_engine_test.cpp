// SPDX-License-Identifier: GPL-3.0-or-later
// Both engines, hair against hair and spheres as axes of what accuracy costs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/accuracy/work_precision.h"
#include "core/gpu_simulation/gpu_engine_method.h"
#include "tests/documents/small_head.h"
#include "tests/gpu/test_backend.h"

namespace hairloom {
namespace {

WorkPrecisionOptions few(std::vector<GridAxis> axes) {
    WorkPrecisionOptions options;
    options.axes = std::move(axes);
    options.time.frames = 12;
    options.strands = 20;
    options.repeats = 1;
    return options;
}

TEST(AccuracyEngine, AGpuIsAnAxisBesideTheCpu) {
    auto device = gpu::createDevice(gpu::testDevice());
    ASSERT_TRUE(device) << device.error().message();
    const Groom groom = smallHead();
    const auto motion = makeRigidMotion("nod", groom).value();
    auto options = few({{std::string(kEngineAxis), {0, 1}}, {"substeps", {1, 4}}});
    options.gpuEngine =
        gpu_simulation::engineOn(**device, std::make_shared<gpu_simulation::KernelLibrary>(**device, ""));
    const auto result = measureWorkPrecision(groom, *motion, options, EngineConverged(32));
    ASSERT_TRUE(result) << result.error().message();
    ASSERT_EQ(result->runs.size(), 4u);
    for (std::size_t run = 0; run < 2; ++run) {
        const WorkPrecisionRun &cpu = result->runs[run], &onGpu = result->runs[run + 2];
        EXPECT_FALSE(cpu.diverged || onGpu.diverged);
        EXPECT_NEAR(cpu.error.rmsMm, onGpu.error.rmsMm, 0.02 + 0.02 * cpu.error.rmsMm);
        EXPECT_NE(cpu.stateHash, onGpu.stateHash) << "another program has run";
        EXPECT_GT(onGpu.milliseconds.median, 0);
    }
    EXPECT_GT(result->runs[0].error.rmsMm, result->runs[1].error.rmsMm);
}

TEST(AccuracyEngine, WithoutAGpuItIsRefused) {
    const Groom groom = smallHead();
    const auto motion = makeRigidMotion("nod", groom).value();
    const auto refused =
        measureWorkPrecision(groom, *motion, few({{std::string(kEngineAxis), {0, 1}}}), EngineConverged(32));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), testing::HasSubstr("GPU"));
}

TEST(AccuracyEngine, WhatIsLeftOutOfTheSceneIsAnError) {
    Groom groom = smallHead();
    groom.spheres.push_back(groom.spheres.front());
    groom.spheres.back().centre = Vec3f(0.18f, 0.06f, 0);
    groom.spheres.back().radius = 0.06f;
    const auto motion = makeRigidMotion("nod", groom).value();
    const auto spheres = measureWorkPrecision(
        groom, *motion, few({{std::string(kSpheresAxis), {0, 1, 2, 9}}, {"substeps", {32}}}),
        EngineConverged(32));
    ASSERT_TRUE(spheres) << spheres.error().message();
    EXPECT_GT(spheres->runs[0].error.rmsMm, 2 * spheres->runs[2].error.rmsMm);
    EXPECT_GT(spheres->runs[1].error.rmsMm, 2 * spheres->runs[2].error.rmsMm);
    EXPECT_EQ(spheres->runs[2].stateHash, spheres->runs[3].stateHash) << "there are no more than two";
    groom.spheres.clear();
    const auto hairHair = measureWorkPrecision(
        groom, *motion, few({{std::string(kHairVolumeAxis), {0, 1}}, {"substeps", {16}}}),
        EngineConverged(32));
    ASSERT_TRUE(hairHair) << hairHair.error().message();
    EXPECT_GT(hairHair->runs[1].error.rmsMm, hairHair->runs[0].error.rmsMm);
}

}  // namespace
}  // namespace hairloom
