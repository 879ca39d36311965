// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/hard_case_engine.h"

namespace hairloom {
namespace {

class CpuHardCaseEngine final : public HardCaseEngine {
  public:
    explicit CpuHardCaseEngine(runtime::Engine engine) : engine_(std::move(engine)) {}
    void reset(std::span<const runtime::RootFrame> roots_ws) override { engine_.reset(roots_ws); }
    std::string setSettings(const runtime::SimulationSettings& settings) override {
        return engine_.setSettings(settings);
    }
    runtime::SimulationSettings settings() const override { return engine_.settings(); }
    void step(const runtime::FrameInput& input) override { engine_.step(input); }
    runtime::StepReport lastStep() override { return engine_.lastStep(); }
    runtime::Measurements measure() override { return engine_.measure(); }
    std::uint64_t stateHash() override { return engine_.stateHash(); }
    void readPositions(std::span<runtime::Float3> positions_ws) override {
        engine_.readPositions(positions_ws);
    }
    void readVelocities(std::span<runtime::Float3> velocities_ws) override {
        engine_.readVelocities(velocities_ws);
    }
    std::uint32_t pointCount() const override { return engine_.pointCount(); }

  private:
    runtime::Engine engine_;
};

class GpuHardCaseEngine final : public HardCaseEngine {
  public:
    explicit GpuHardCaseEngine(gpu_simulation::StrandEngine engine, runtime::SimulationSettings settings)
        : engine_(std::move(engine)), settings_(settings) {}

    void reset(std::span<const runtime::RootFrame> roots_ws) override { keep(engine_.reset(roots_ws)); }
    std::string setSettings(const runtime::SimulationSettings& settings) override {
        if (const auto taken = engine_.setSettings(settings); !taken) return taken.error().message();
        settings_ = settings;
        return {};
    }
    runtime::SimulationSettings settings() const override { return settings_; }
    void step(const runtime::FrameInput& input) override { keep(engine_.step(input)); }
    runtime::StepReport lastStep() override {
        runtime::StepReport report;
        const auto read = engine_.report();
        if (!read) {
            keep(tl::unexpected(read.error()));
            return report;
        }
        report.rejectedRoots = read->rejectedRoots;
        report.rejectedSpheres = read->rejectedSpheres;
        report.rejectedWinds = read->rejectedWinds;
        report.restoredStrands = read->restoredStrands;
        return report;
    }
    runtime::Measurements measure() override {
        const auto measured = engine_.measure();
        if (measured) return *measured;
        keep(tl::unexpected(measured.error()));
        runtime::Measurements lost;
        lost.nanCount = engine_.pointCount();
        return lost;
    }
    std::uint64_t stateHash() override {
        const auto hash = engine_.stateHash();
        if (hash) return *hash;
        keep(tl::unexpected(hash.error()));
        return 0;
    }
    void readPositions(std::span<runtime::Float3> positions_ws) override {
        keep(engine_.readPositions(positions_ws));
    }
    void readVelocities(std::span<runtime::Float3> velocities_ws) override {
        keep(engine_.readVelocities(velocities_ws));
    }
    std::uint32_t pointCount() const override { return engine_.pointCount(); }
    std::string problem() const override { return problem_; }

  private:
    void keep(const Status& status) {
        if (problem_.empty() && !status) problem_ = status.error().message();
    }

    gpu_simulation::StrandEngine engine_;
    runtime::SimulationSettings settings_;
    std::string problem_;
};

}  // namespace

HardCaseEngineResult makeCpuHardCaseEngine(const runtime::StrandsView& strands,
                                           const runtime::SimulationSettings& settings) {
    auto made = runtime::Engine::make(strands, settings);
    if (!made.engine) return {nullptr, std::move(made.error)};
    return {std::make_unique<CpuHardCaseEngine>(std::move(*made.engine)), {}};
}

HardCaseEngineFactory gpuHardCaseEngines(gpu::Device& device,
                                         std::shared_ptr<gpu_simulation::KernelLibrary> kernels) {
    return [&device, kernels = std::move(kernels)](
               const runtime::StrandsView& strands,
               const runtime::SimulationSettings& settings) -> HardCaseEngineResult {
        gpu_simulation::EngineOptions options;
        options.layout = gpu_simulation::layoutFor(device.info().type);
        auto engine = gpu_simulation::StrandEngine::make(device, kernels, strands, settings, options);
        if (!engine) return {nullptr, engine.error().message()};
        return {std::make_unique<GpuHardCaseEngine>(std::move(*engine), settings), {}};
    };
}

}  // namespace hairloom
