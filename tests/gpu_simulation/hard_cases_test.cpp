// SPDX-License-Identifier: GPL-3.0-or-later
// The hard cases of the strand engine, on the device; each a test of its own, as each compiles kernels of its
// own.
#include "core/stability/stability.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

struct DeviceCase {
    StabilityMethod method;
    std::size_t number;
};

void PrintTo(const DeviceCase& which, std::ostream* out) {
    *out << which.method.name() << " " << which.number;
}

class HardCases : public GpuSimulationTest, public testing::WithParamInterface<DeviceCase> {};

constexpr std::size_t kCases = 30;

std::vector<DeviceCase> casesOf(const StabilityMethod& method) {
    std::vector<DeviceCase> cases;
    for (std::size_t i = 0; i < kCases; ++i) {
        cases.push_back({method, i});
    }
    return cases;
}

/// What the engine on the CPU holds, the device holds too.
TEST_P(HardCases, DeviceMeetsTheCpusHardCases) {
    const auto& [method, number] = GetParam();
    ASSERT_LT(number, hardCases().size());
    const HardCase& hardCase = hardCases()[number];
    StabilityOptions quick;
    quick.stepsAtRest = 400;
    quick.freeSeconds = 2.0;
    quick.storms = 2;
    quick.integrators = {runtime::Integrator::verlet};
    if (!runHardCase(hardCase, method, quick).pass) GTEST_SKIP() << "the CPU does not hold it either";
    StabilityOptions onDevice = quick;
    onDevice.engines = gpuHardCaseEngines(*device(), library());
    const StabilityResult result = runHardCase(hardCase, method, onDevice);
    EXPECT_TRUE(result.pass) << result.number << " " << result.name << ": " << result.closest().what << " "
                             << result.closest().worst << " " << result.closest().unit << ", threshold "
                             << result.closest().threshold;
}

INSTANTIATE_TEST_SUITE_P(Rods, HardCases, testing::ValuesIn(casesOf(kRods)));
INSTANTIATE_TEST_SUITE_P(BackwardEuler, HardCases,
                         testing::ValuesIn(casesOf(springsWith(runtime::Integrator::implicitEuler))));

/// The list above is as long as theirs.
TEST(HardCaseList, IsWhole) {
    EXPECT_EQ(hardCases().size(), kCases);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
