// SPDX-License-Identifier: GPL-3.0-or-later
// The hard cases of the strand engine, on the device.
#include "core/accuracy/stability.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

class HardCases : public GpuSimulationTest {};

/// What the engine on the CPU holds, the device holds too.
TEST_F(HardCases, WhatTheCpuHoldsTheDeviceHolds) {
    StabilityOptions quick;
    quick.stepsAtRest = 400;
    quick.freeSeconds = 2.0;
    quick.integrators = {runtime::Integrator::verlet};
    StabilityOptions onDevice = quick;
    onDevice.engines = gpuTrialEngines(*device(), library());
    int held = 0;
    for (const HardCase& hardCase : hardCases()) {
        if (!runHardCase(hardCase, runtime::Integrator::verlet, quick).pass) continue;
        const StabilityResult result = runHardCase(hardCase, runtime::Integrator::verlet, onDevice);
        EXPECT_TRUE(result.pass) << result.number << " " << result.name << ": " << result.closest().what
                                 << " " << result.closest().worst << " " << result.closest().unit << ", mark "
                                 << result.closest().mark;
        ++held;
    }
    EXPECT_GE(held, 18);
}

}  // namespace
}  // namespace hairloom::gpu_simulation
