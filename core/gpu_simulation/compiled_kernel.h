// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/gpu/device.h"

namespace hairloom::gpu_simulation {

/// The pipeline of a kernel without permutations, `name`.comp of the compiled shaders. Errors: it does not
/// exist for this kind of device, or the device refuses it.
Result<gpu::ComputePipelinePtr> compiledKernel(gpu::Device& device, const char* name);

}  // namespace hairloom::gpu_simulation
