// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The strand engine (docs/engine.md) on a GPU: what runtime::Engine does, in one dispatch per frame and batch
// of strands. docs/gpu-simulation.md says how. Particles stay on the device; what is read back is read when
// asked.
//
// Differs from runtime::Engine: the results agree within rounding, not in bits; the test for continuous
// collision runs wherever points collide and leaves slow ones out itself, so that the plan needs nothing from
// the device; sleeping strands are known to the device only; beside a body, more substeps are taken for roots
// that are or just were fast, not for fast hair. Does not do: backward Euler.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gpu_simulation/device_body.h"
#include "core/gpu_simulation/gpu_hair_volume.h"
#include "core/gpu_simulation/kernel_library.h"
#include "core/gpu_simulation/strand_batch.h"
#include "runtime/engine/frame_setup.h"
#include "runtime/engine/state_read.h"

namespace hairloom::gpu_simulation {

struct EngineOptions {
    LayoutOptions layout;
    bool velocities = false;  ///< written each frame beside the positions
    /// While a plan's kernel is being made, the frame waits for it. Else the last plan goes on until it is
    /// ready, with the settings that it was made from.
    bool waitForKernels = true;
    /// Hair against hair between frames.
    std::optional<runtime::HairVolumeSettings> hairVolume = {};
    /// That rods meet, as Engine::setBody() has it; springs pass through it. Not on Direct3D 11.
    std::shared_ptr<const runtime::BodyField> body = {};
};

/// What the last frame took and met.
struct FrameReport {
    double milliseconds = 0.0;        ///< on the device, of the dispatches; 0 without timestamps
    double kernelMilliseconds = 0.0;  ///< that the frame waited for kernels to be made
    std::uint32_t restoredStrands = 0;
    std::uint32_t guardedStrands = 0;  ///< as in runtime::StepReport
    std::uint32_t asleep = 0;          ///< strands
    float fastest = 0.0f;              ///< m/s
    // Of the input, as runtime::StepReport counts them.
    std::uint32_t rejectedRoots = 0;
    std::uint32_t rejectedSpheres = 0;
    std::uint32_t rejectedWinds = 0;
};

/// Roots that the device itself has found (GpuHead), in place of FrameInput::roots_ws.
struct DeviceRoots {
    gpu::BufferPtr frames_ws;        ///< two float4 a strand: position; rotation since rest
    runtime::Float3 min_ws, max_ws;  ///< a box that holds all positions
    float motion = 0.0f;             ///< metres; no root goes farther in the frame
    bool moved = true;               ///< false: all are where they were in the last frame
};

class StrandEngine {
  public:
    /// Strands at rest. `device` outlives the engine. Errors: those of runtime::Engine::make, settings
    /// without kernels, what the device says.
    static Result<StrandEngine> make(gpu::Device& device, std::shared_ptr<KernelLibrary> kernels,
                                     const runtime::StrandsView& strands,
                                     const runtime::SimulationSettings& settings,
                                     const EngineOptions& options);
    StrandEngine(StrandEngine&&) noexcept;
    StrandEngine& operator=(StrandEngine&&) noexcept;
    ~StrandEngine();

    /// Places all strands in their rest shape on these roots, without speed.
    Status reset(std::span<const runtime::RootFrame> roots_ws);
    /// Takes other settings from the next frame on, or from when their kernel is ready.
    Status setSettings(const runtime::SimulationSettings& settings);
    /// As runtime::Engine::setSkinSpheres().
    void setSkinSpheres(std::span<const std::uint8_t> ofSkin);
    /// Those of the last frame.
    const runtime::SimulationSettings& settings() const;
    /// As runtime::Engine::setPoses(), from the next frame on. Errors: why they are refused.
    Status setPoses(std::span<const runtime::PoseView> poses);
    /// As FrameInput::poseAmounts sets them. Errors: another number than there are poses.
    Status setPoseAmounts(std::span<const float> amounts);

    /// Advances to the end of the frame. A dt that is not above 0 changes nothing. Returns before the device
    /// has done it; waits where more than two frames are under way.
    Status step(const runtime::FrameInput& input);
    /// Records the frame into the caller's list, outside a pass; the list has to be submitted before anything
    /// else is asked of the engine.
    Status record(gpu::CommandList& list, const runtime::FrameInput& input);
    /// Likewise; the roots are what the list has written into their buffer before, those of `input` are not
    /// read, nor are poses inside it: record a frame for each, whose reports add up where `continues`.
    Status record(gpu::CommandList& list, const runtime::FrameInput& input, const DeviceRoots& roots,
                  bool continues = false);

    std::uint32_t strandCount() const;
    std::uint32_t pointCount() const;
    /// After the last recorded frame: float4 per point, strand after strand in the order of make(), metres,
    /// world, w = 1.
    gpu::BufferPtr positions_ws() const;
    /// Likewise, m/s; null unless asked for.
    gpu::BufferPtr velocities_ws() const;

    /// Words of the last recorded frame, for who reads them later: reportFrom() makes a report of them.
    gpu::BufferPtr reportWords() const;
    static constexpr std::size_t kReportWords = 4;
    /// `substep`: seconds of one in that frame. Without times.
    static FrameReport reportFrom(std::span<const std::uint32_t, kReportWords> words, float substep);
    float substep() const;  ///< seconds, of the last recorded frame; 0 before the first
    const runtime::RestShape& restShape() const;

    /// The plan that the last frame ran by.
    const runtime::EffectPlan& plan() const;
    /// Bytes of buffers that exist because of this effect.
    std::size_t effectBytes(runtime::Effect effect) const;
    /// Of hair against hair, and of the body and what is known of it.
    std::size_t volumeBytes() const;
    std::size_t bodyBytes() const;
    /// That the strands meet, in the pose of the last recorded frame; null: none.
    const DeviceBody* body() const;
    /// Bytes of particles and roots that a substep reads or writes, of all strands, where they are
    /// not kept in threads: each frame's is shared by its substeps.
    std::size_t frameBytes() const;

    // These wait for the device.
    /// Until the last step is done; milliseconds of its dispatches, 0 without timestamps.
    Result<double> wait();
    Result<FrameReport> report();
    /// All of it, in the form of the engine on the CPU.
    Result<runtime::State> readState();
    Status writeState(const runtime::State& state);
    Result<runtime::Measurements> measure();
    Status readPositions(std::span<runtime::Float3> positions_ws);
    Status readVelocities(std::span<runtime::Float3> velocities_ws);
    Result<std::uint64_t> stateHash();

  private:
    struct Impl;
    explicit StrandEngine(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom::gpu_simulation
