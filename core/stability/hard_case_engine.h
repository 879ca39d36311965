// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a hard case runs: the strand engine on the CPU, or on a GPU.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/gpu_simulation/strand_engine.h"
#include "hairloom/engine.h"

namespace hairloom {

class HardCaseEngine {
  public:
    virtual ~HardCaseEngine() = default;
    virtual void reset(std::span<const runtime::RootFrame> roots_ws) = 0;
    /// Empty, or why they are refused.
    virtual std::string setSettings(const runtime::SimulationSettings& settings) = 0;
    virtual runtime::SimulationSettings settings() const = 0;
    virtual void step(const runtime::FrameInput& input) = 0;
    /// What of it is known: of times nothing.
    virtual runtime::StepReport lastStep() = 0;
    virtual runtime::Measurements measure() = 0;
    virtual std::uint64_t stateHash() = 0;
    virtual void readPositions(std::span<runtime::Float3> positions_ws) = 0;
    virtual void readVelocities(std::span<runtime::Float3> velocities_ws) = 0;
    virtual std::uint32_t pointCount() const = 0;
    /// Empty, or what went wrong with the device.
    virtual std::string problem() const { return {}; }
};

/// Strands at rest, or in words why there are none.
struct HardCaseEngineResult {
    std::unique_ptr<HardCaseEngine> engine;
    std::string error;
};
using HardCaseEngineFactory = std::function<HardCaseEngineResult(
    const runtime::StrandsView& strands, const runtime::SimulationSettings& settings)>;

HardCaseEngineResult makeCpuHardCaseEngine(const runtime::StrandsView& strands,
                                           const runtime::SimulationSettings& settings);
/// `device` outlives what the maker makes.
HardCaseEngineFactory gpuHardCaseEngines(gpu::Device& device,
                                         std::shared_ptr<gpu_simulation::KernelLibrary> kernels);

}  // namespace hairloom
