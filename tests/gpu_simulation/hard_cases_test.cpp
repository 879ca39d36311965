// SPDX-License-Identifier: GPL-3.0-or-later
// The hard cases of the strand engine, on the device.
#include "core/accuracy/stability.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

class HardCases : public GpuSimulationTest {};

TEST_F(HardCases, AllAreMetWithTheDefaultIntegrator) {
    StabilityOptions quick;
    quick.stepsAtRest = 800;
    quick.freeSeconds = 2.0;
    quick.engines = gpuTrialEngines(*device(), library());
    quick.integrators = {runtime::Integrator::verlet};
    const runtime::Integrator integrator = runtime::Integrator::verlet;
    for (const StabilityResult& result : runHardCases({&integrator, 1}, quick)) {
        EXPECT_TRUE(result.pass) << result.number << " " << result.name << ": " << result.closest().what
                                 << " " << result.closest().worst << " " << result.closest().unit << ", mark "
                                 << result.closest().mark;
    }
}

}  // namespace
}  // namespace hairloom::gpu_simulation
