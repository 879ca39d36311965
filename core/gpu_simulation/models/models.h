// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The models that there are.

#include "core/gpu_simulation/strand_model.h"

namespace hairloom::gpu_simulation {

const GpuModel& gpuRods();
const GpuModel& gpuSprings();

}  // namespace hairloom::gpu_simulation
