// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/compiled_kernel.h"

#include <fmt/format.h>

#include "shaders/shaders.h"

namespace hairloom::gpu_simulation {

Result<gpu::ComputePipelinePtr> compiledKernel(gpu::Device& device, const char* name) {
    const shaders::Shader* found = shaders::find(fmt::format("{}.comp", name));
    if (found == nullptr) return fail(fmt::format("the kernel '{}' does not exist", name));
    const auto shader =
        device.createShader({name, gpu::ShaderStage::Compute, std::as_bytes(found->spirv), found->dxbc});
    if (!shader) return tl::unexpected(shader.error());
    return device.createComputePipeline({name, *shader});
}

}  // namespace hairloom::gpu_simulation
