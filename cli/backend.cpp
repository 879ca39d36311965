// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/backend.h"

namespace hairloom::cli {

GpuBackend::GpuBackend(std::unique_ptr<gpu::Device> device)
    : device_(std::move(device)),
      kernels_(
          std::make_shared<gpu_simulation::KernelLibrary>(*device_, gpu_simulation::userKernelFolder())) {}

Result<std::unique_ptr<GpuBackend>> GpuBackend::make(gpu::Backend backend,
                                                     std::optional<std::uint32_t> index) {
    gpu::DeviceOptions options;
    options.backend = backend;
    options.index = index;
    auto device = gpu::createDevice(options);
    if (!device) return tl::unexpected(device.error());
    return std::unique_ptr<GpuBackend>(new GpuBackend(std::move(*device)));
}

}  // namespace hairloom::cli
