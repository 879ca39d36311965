// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/backend.h"

#include "core/software/device.h"

namespace hairloom::cli {

GpuBackend::GpuBackend(std::unique_ptr<gpu::Device> device)
    : device_(std::move(device)),
      kernels_(
          std::make_shared<gpu_simulation::KernelLibrary>(*device_, gpu_simulation::userKernelFolder())) {}

Result<std::unique_ptr<GpuBackend>> GpuBackend::make(std::optional<gpu::Backend> backend,
                                                     std::optional<std::uint32_t> index) {
    gpu::DeviceOptions options;
    options.backend = backend;
    options.index = index;
    auto device = gpu::createDevice(options);
    if (!device) return tl::unexpected(device.error());
    return std::make_unique<GpuBackend>(std::move(*device));
}

Result<DrawingDevice> chooseDrawingDevice(bool byPasses) {
    if (byPasses) {
        auto made = GpuBackend::make({}, {});
        if (!made) return tl::unexpected(made.error());
        return DrawingDevice{std::move(*made), {}};
    }
    software::DeviceChoice chosen = software::chooseDevice();
    return DrawingDevice{std::make_unique<GpuBackend>(std::move(chosen.device)), chosen.why};
}

Result<JobEngine> chooseJobEngine(const std::string& wish, std::optional<gpu::Backend> backend,
                                  std::optional<std::uint32_t> index, const Groom& groom) {
    if (wish == "cpu") return JobEngine{{EngineKind::cpu, "you asked for it"}, nullptr};
    auto made = GpuBackend::make(backend, index);
    if (!made && wish == "gpu") return tl::unexpected(made.error());
    if (!made) return JobEngine{{EngineKind::cpu, "there is no GPU: " + made.error().message()}, nullptr};
    JobEngine engine;
    engine.choice = chooseEngine(wish == "gpu" ? EngineWish::gpu : EngineWish::automatic, &(*made)->device(),
                                 (*made)->kernels(), groom, EngineMemory::ofUser());
    if (engine.choice.kind == EngineKind::gpu) {
        engine.gpu = std::move(*made);
    } else if (wish == "gpu") {
        return fail(engine.choice.why, "expected a groom that the engine can run on a GPU, or --engine cpu");
    }
    return engine;
}

}  // namespace hairloom::cli
