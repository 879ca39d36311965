// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the engine's own sources share; not for callers.

#include <deque>

#include "core/gpu_simulation/strand_engine.h"
#include "core/gpu_simulation/strand_model.h"
#include "runtime/engine/frame_pieces.h"
#include "runtime/engine/gpu_frame.h"
#include "runtime/engine/poses.h"

namespace hairloom::gpu_simulation {

/// Words of StrandEngine::reportWords() that are of the end of a frame.
inline constexpr std::size_t kReportFastest = 0, kReportAsleep = 2;

struct StrandEngine::Impl {
    /// What a frame is to run by.
    struct Run {
        runtime::SimulationSettings settings;
        runtime::FrameWind wind;
        runtime::EffectPlan plan;
    };

    gpu::Device& device;
    std::shared_ptr<KernelLibrary> kernels;
    EngineOptions options;
    std::shared_ptr<const runtime::RestShape> shape;
    std::unique_ptr<DeviceStrands> model;  ///< of run.settings.strandModel
    std::vector<StrandBatch> batches;
    std::optional<GpuHairVolume> volume;
    std::optional<DeviceBody> body;  ///< that the model meets
    bool bodyMoves = false;          ///< in the frame
    runtime::Vector<std::uint8_t> skinSpheres;
    float fastRoots = 0.0f;    ///< m/s, of roots, and of what they set going not long ago
    std::size_t pressing = 0;  ///< of movingSpheres: those behind it stand for the body's skin
    gpu::BufferPtr reportBuffer, positions, velocities;
    gpu::BufferPtr waking, spheres;  // null while sleep, or many spheres, are off

    runtime::SimulationSettings wanted;
    Run run;               ///< of the last frame
    bool adopted = false;  ///< `run` has kernels and buffers
    bool switching = false;

    std::shared_ptr<const runtime::PoseSet> poses;  ///< null: none
    runtime::Vector<float> poseAmounts;

    // Of the scene.
    runtime::FrameRoots placed;
    std::uint32_t rejectedWinds = 0;
    runtime::FrameSpheres frameSpheres;
    runtime::Vector<runtime::Sphere> spheresBefore;
    runtime::FramePieces pieces;
    runtime::Vector<runtime::MovingSphere> movingSpheres;
    runtime::Vector<runtime::MovingCapsule> movingCapsules;  // where the model meets them as they are
    float substep = 0.0f;                                    ///< seconds of the last one; 0 before the first
    std::optional<std::array<double, 3>> origin_ws;          ///< of the last frame; none before the first
    runtime::Float3 originShift;  ///< by which that of the frame moves what was known
    bool restsVoid = false;       ///< other settings: nothing sleeps
    bool wakeAll = false;
    bool rootsMoved = false;     ///< in the last frame, as the device knows
    bool rootsOfDevice = false;  ///< `placed` is of an earlier frame: the device found them itself since
    gpu::ComputePipelinePtr rootRows;  ///< puts roots of the device in order, once there are some

    std::deque<gpu::SubmissionPtr> submissionsInFlight;
    std::optional<runtime::State> known;  ///< what was read since the last frame
    double milliseconds = 0.0;            ///< of the last step that was waited for
    double kernelMilliseconds = 0.0;      ///< that the last frame waited for kernels
    mutable gpu::BufferPtr readBack;      ///< what is read passes through it; grows

    Impl(gpu::Device& d, std::shared_ptr<KernelLibrary> k, EngineOptions o)
        : device(d), kernels(std::move(k)), options(o) {}

    // strand_engine.cpp
    std::string velocityError() const;
    Status makeBody(const runtime::SimulationSettings& settings);
    Status makeBuffers();
    Status takeModel(const runtime::SimulationSettings& settings);
    Status allocate();
    void takePoseAmounts(std::span<const float> amounts);
    void followPoses(bool others);
    Status adopt(const Run& next);
    Status choose(const runtime::FrameInput& input, runtime::Float3 low, runtime::Float3 high);
    Run runFor(const runtime::SimulationSettings& settings, const runtime::FrameInput& input,
               runtime::Float3 low, runtime::Float3 high);
    Result<bool> kernelsFor(const Run& next, bool wait);
    // strand_engine_frame.cpp
    Status record(gpu::CommandList& list, const runtime::FrameInput& input, const DeviceRoots* deviceRoots,
                  bool continues = false);
    /// Without poses inside, from the origin of now.
    Status recordStraight(gpu::CommandList& list, const runtime::FrameInput& input,
                          const DeviceRoots* deviceRoots);
    void forgetLastPiece(gpu::CommandList& list);
    bool takeRoots(const runtime::FrameInput& input);
    bool takeRoots(const DeviceRoots& given);
    Status gatherRoots(gpu::CommandList& list, const DeviceRoots& given);
    void moveOrigin(std::array<double, 3> next_ws);
    /// Whether strands under these settings meet the body, once it has a pose.
    bool meetsBody(const runtime::SimulationSettings& settings) const {
        return body && body->hasPose() && runtime::modelOf(settings.strandModel).meetsBody;
    }
    bool followsBody() const;
    std::uint32_t takeBody(const runtime::FrameInput& input, std::uint32_t usual);
    std::span<const runtime::MovingSphere> pressingSpheres() const {
        return std::span(movingSpheres).first(pressing);
    }
    void uploadRoots(gpu::CommandList& list, const runtime::Vector<bool>& moved) const;
    void uploadSpheres(gpu::CommandList& list);
    void uploadChanges(gpu::CommandList& list);
    shaders::SimulationConstants constants(const runtime::SubstepContext& context,
                                           const runtime::FrameInput& input, const StrandBatch& batch) const;
    void dispatch(gpu::CommandList& list, const StrandBatch& batch,
                  const shaders::SimulationConstants& constants,
                  const runtime::SubstepContext& context) const;
    // strand_engine_state.cpp
    runtime::State emptyState() const;
    Result<runtime::State> readState();
    Result<std::vector<std::byte>> readTogether(const std::vector<gpu::BufferPtr>& buffers) const;
    void takeBatch(const StrandBatch& batch, std::span<const std::byte>& bytes, runtime::State& state) const;
    Status writeBatch(gpu::CommandList& list, const StrandBatch& batch, const runtime::State& state) const;
    Status writeState(const runtime::State& given);
};

}  // namespace hairloom::gpu_simulation
