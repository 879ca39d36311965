// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair and head that move on the device and are drawn there: bones and spheres go up, strands, follow hairs
// and head are moved by kernels, and the renderer draws what they write. No point crosses in either
// direction. What is told of a frame comes back a frame or two later, when the device has long been done with
// it.

#include <deque>

#include "core/gpu_simulation/gpu_body_push.h"
#include "core/gpu_simulation/gpu_follow_hairs.h"
#include "core/gpu_simulation/gpu_head.h"
#include "core/live/groom_scene.h"
#include "core/render/renderer.h"
#include "core/simulation/scene_input.h"
#include "runtime/engine/frame_pieces.h"

namespace hairloom {

/// What the device told of a frame.
struct DeviceFrame {
    std::uint64_t frame = 0;  ///< number of the record() that it is of, from 1; 0: nothing was told yet
    gpu_simulation::FrameReport report;
    double maxStretch = 0;      ///< as in runtime::Measurements, also what follows
    double maxPenetration = 0;  ///< metres
    double kineticEnergy = 0;   ///< joules
    std::uint64_t nanCount = 0;
    std::uint64_t restoredStrands = 0, guardedStrands = 0;  ///< of all frames that were told of
    std::vector<Vec3f> positions_ws;  ///< in the order of the groom's points, where they are told; else empty
};

class DeviceHair {
  public:
    /// Strands at rest on `start`. `device` outlives it. `skin`: of the scalp, whose bones the poses name;
    /// null: it moves rigidly. Kernels that are missing are waited for at first, later made beside the
    /// frames. Errors: a groom that cannot be simulated, settings without kernels, what the device says.
    static Result<DeviceHair> make(gpu::Device& device,
                                   std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                   const GroomScene& scene, const SkinWeights* skin, const HeadPose& start);

    /// From the next frame on, or from when their kernel is ready.
    Status setSettings(const runtime::SimulationSettings& settings);
    /// As Simulation::setPoseAmounts().
    Status setPoseAmounts(std::span<const float> amounts);
    void setSpheres(std::vector<CollisionSphere> spheres) { input_.setSpheres(std::move(spheres)); }

    /// Whether frames from the next on tell where all strands are: for marks that are drawn on them.
    void setReadsPositions(bool on) { readsPositions_ = on; }

    /// Records a frame of `dt` seconds that ends on `pose`, outside a pass; `time`: seconds at its end.
    /// `within`: poses on the way, at equal shares of dt.
    Status record(gpu::CommandList& list, float dt, double time, const HeadPose& pose,
                  std::span<const HeadPose> within = {});
    /// The list that record() recorded into went to the device.
    void submitted(gpu::SubmissionPtr submission);
    /// Hands over what the last record() moves, to a renderer that has the scene.
    Status show(render::Renderer& renderer, bool hair, bool head) const;

    /// The latest that has come back; never waits.
    const DeviceFrame& latestFrame() const { return latest_; }
    const gpu_simulation::StrandEngine& engine() const { return engine_; }

    // These wait for the device.
    /// For another engine to go on from.
    Result<std::shared_ptr<const runtime::State>> readState();
    /// Of as many strands of as many points.
    Status writeState(const runtime::State& state);
    /// In the order of the groom's points.
    Status readPositions(std::span<Vec3f> positions_ws);

  private:
    /// A frame on its way back.
    struct Readback {
        gpu::BufferPtr buffer, positions;
        bool hasPositions = false;
        gpu::SubmissionPtr submission;  ///< null: the slot is free, or its list is being recorded
        std::uint64_t frame = 0;
        float substep = 0;
    };
    DeviceHair(gpu::Device& device, SceneInput input, gpu_simulation::StrandEngine engine,
               gpu_simulation::GpuHead head)
        : device_(&device), input_(std::move(input)), engine_(std::move(engine)), head_(std::move(head)) {}

    Status makeBuffers();
    Status recordDrawn(gpu::CommandList& list);
    std::vector<runtime::BonePose> headBones(const HeadPose& pose) const;
    std::vector<runtime::BonePose> bonesOf(const HeadPose& pose) const;
    /// What goes straight on through a frame, or a part of one.
    Status recordStraight(gpu::CommandList& list, const runtime::FrameInput& input, bool continues,
                          std::vector<Vec3f> morphed_ss);
    std::vector<Vec3f> morphedAt(std::size_t piece, const HeadPose& end,
                                 std::span<const HeadPose> within) const;
    std::vector<runtime::Sphere> pressing(std::span<const runtime::Sphere> spheres,
                                          std::span<const runtime::Capsule> capsules) const;
    void recordMeasures(gpu::CommandList& list, std::span<const runtime::Sphere> spheres);
    void recordExtent(gpu::CommandList& list);
    void recordReadback(gpu::CommandList& list);
    void listen();
    void take(const Readback& readback, std::span<const std::byte> bytes);
    void forgetSeen(const HeadPose& pose);
    /// Where hair may be at the end of the last recorded frame, by what was told of earlier ones.
    Box3f hairBounds() const;
    std::vector<Vec3f> hairSample() const;
    gpu::BufferPtr drawnPoints() const;

    gpu::Device* device_;
    SceneInput input_;
    gpu_simulation::StrandEngine engine_;
    gpu_simulation::GpuHead head_;
    std::optional<gpu_simulation::GpuFollowHairs> follow_;
    std::optional<gpu_simulation::GpuBodyPush> push_;
    gpu::BufferPtr pushed_;  ///< strands that are drawn themselves, out of the body
    runtime::FramePieces pieces_;
    std::vector<runtime::BonePose> bones_;        ///< of the last frame: the head's, then its body's
    std::size_t headBones_ = 0;                   ///< of bones_
    std::vector<Vec3f> morphed_ss_;               ///< likewise; empty: no morph target moves the head
    std::vector<runtime::Sphere> placedSpheres_;  ///< likewise
    bool skinned_ = false, readsPositions_ = false;
    float reach_ = 0;  ///< metres that hair gets away from its root
    std::uint32_t drawnPointCount_ = 0, sampleCount_ = 0, sampleStep_ = 1;
    std::vector<Vec3f> restSample_;

    gpu::BufferPtr measuredRest_, measures_, sphereBuffer_, extent_, samples_;
    gpu::ComputePipelinePtr measureKernel_, extentKernel_;
    std::vector<Readback> readbacks_;
    std::size_t recording_ = 0;  ///< of tellings_, whose list is open or on its way; their number: none
    std::uint64_t frame_ = 0;
    std::uint64_t seenSince_ = 0;  ///< frames before it tell nothing of where hair is now

    DeviceFrame latest_;
    /// Hair in a frame: its box, and some of its points.
    struct SeenHair {
        std::uint64_t frame = 0;
        Box3f box;
        std::vector<Vec3f> sample;
    };
    SeenHair seen_, seenBefore_;
};

}  // namespace hairloom
