// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/models/models.h"

#include <array>

namespace hairloom::gpu_simulation {

const GpuModel& gpuModelOf(runtime::StrandModel model) {
    // In the order of StrandModel.
    static const std::array<const GpuModel*, 2> kModels{&gpuRods(), &gpuSprings()};
    return *kModels[static_cast<std::size_t>(model)];
}

}  // namespace hairloom::gpu_simulation
