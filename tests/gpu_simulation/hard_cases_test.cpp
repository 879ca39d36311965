// SPDX-License-Identifier: GPL-3.0-or-later
// The hard cases of the strand engine, on the device; each a test of its own, as each compiles kernels of its
// own.
#include "core/stability/stability.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

class HardCases : public GpuSimulationTest, public testing::WithParamInterface<std::size_t> {};

/// What the engine on the CPU holds, the device holds too.
TEST_P(HardCases, DeviceMeetsTheCpusHardCases) {
    ASSERT_LT(GetParam(), hardCases().size());
    const HardCase& hardCase = hardCases()[GetParam()];
    StabilityOptions quick;
    quick.stepsAtRest = 400;
    quick.freeSeconds = 2.0;
    quick.storms = 2;
    quick.integrators = {runtime::Integrator::verlet};
    if (!runHardCase(hardCase, kRods, quick).pass) GTEST_SKIP() << "the CPU does not hold it either";
    StabilityOptions onDevice = quick;
    onDevice.engines = gpuHardCaseEngines(*device(), library());
    const StabilityResult result = runHardCase(hardCase, kRods, onDevice);
    EXPECT_TRUE(result.pass) << result.number << " " << result.name << ": " << result.closest().what << " "
                             << result.closest().worst << " " << result.closest().unit << ", threshold "
                             << result.closest().threshold;
}

constexpr std::size_t kCases = 30;
INSTANTIATE_TEST_SUITE_P(Rods, HardCases, testing::Range(std::size_t{0}, kCases));

/// The list above is as long as theirs.
TEST(HardCaseList, IsWhole) {
    EXPECT_EQ(hardCases().size(), kCases);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
