// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A GPU for jobs that simulate.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/gpu_simulation/gpu_engine_method.h"
#include "core/live/engine_choice.h"
#include "core/render/fibre_material.h"

namespace hairloom::cli {

/// The graphics APIs as --backend names them.
inline const std::map<std::string, gpu::Backend> kGpuBackends{{"vulkan", gpu::Backend::Vulkan},
                                                              {"d3d11", gpu::Backend::Direct3D11}};

/// What becomes of light that hair scatters, as --scatter names it.
inline const std::map<std::string, render::Scattering> kScatterings{{"single", render::Scattering::single},
                                                                    {"dual", render::Scattering::dual},
                                                                    {"volume", render::Scattering::volume}};
/// The shading models as --shading names them.
inline const std::map<std::string, render::ShadingModel> kShadingModels{
    {"kajiya", render::ShadingModel::kajiya},
    {"marschner", render::ShadingModel::marschner},
    {"sadeghi", render::ShadingModel::sadeghi}};

/// What an option that takes such choices lists.
template <class T>
std::vector<std::string> namesOf(const std::map<std::string, T>& choices) {
    std::vector<std::string> names;
    for (const auto& [name, value] : choices) names.push_back(name);
    return names;
}

/// A device and the kernels on it; outlives what simulates on it.
class GpuBackend {
  public:
    /// By the index in `devices`, or the best, of one graphics API or any. Errors: there is none.
    static Result<std::unique_ptr<GpuBackend>> make(std::optional<gpu::Backend> backend,
                                                    std::optional<std::uint32_t> index);

    /// The software renderer draws, and simulates nothing.
    explicit GpuBackend(std::unique_ptr<gpu::Device> device);

    gpu::Device& device() { return *device_; }
    const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels() const { return kernels_; }
    MethodMaker engine() { return gpu_simulation::engineOn(*device_, kernels_); }
    const std::string& deviceName() const { return device_->info().name; }

  private:
    std::unique_ptr<gpu::Device> device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
};

/// A device that draws, and what is to be said of how it was chosen.
struct DrawingDevice {
    std::unique_ptr<GpuBackend> backend;
    std::string note;  ///< empty where it is as was asked for
};
/// The best GPU, or the software renderer where there is none. `byPasses`: what is drawn needs passes that
/// only a graphics API has, as its rasteriser on the processor. Errors: there is nothing that draws it.
Result<DrawingDevice> chooseDrawingDevice(bool byPasses);

/// What moves the hair of a job.
struct JobEngine {
    EngineChoice choice;
    std::unique_ptr<GpuBackend> gpu;  ///< null on the CPU
};
/// `wish` as --engine has it. Errors: a GPU was asked for and there is none, or it cannot run the groom.
Result<JobEngine> chooseJobEngine(const std::string& wish, std::optional<gpu::Backend> backend,
                                  std::optional<std::uint32_t> index, const Groom& groom);

}  // namespace hairloom::cli
