// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The engine on a GPU as a way for Simulation to move a groom's strands.

#include "core/gpu_simulation/kernel_library.h"
#include "core/simulation/simulation.h"

namespace hairloom::gpu_simulation {

class StrandEngine;

/// For SimulationOptions::backend; `device` outlives the simulation. Each step waits for the device, and each
/// look at positions or measures reads them back. The time of single effects is not known, as one kernel runs
/// all of them: `bench gpu-sim` measures it.
MethodMaker engineOn(gpu::Device& device, std::shared_ptr<KernelLibrary> kernels);

/// What each effect does and how many bytes it has. One kernel runs them all: none that is on has a time.
std::vector<EffectReport> effectReports(const StrandEngine& engine);

}  // namespace hairloom::gpu_simulation
