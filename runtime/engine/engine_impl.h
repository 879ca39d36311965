// SPDX-License-Identifier: MIT
#pragma once
// What is behind Engine, for its own sources.

#include <array>
#include <functional>

#include "engine/frame_pieces.h"
#include "engine/frame_setup.h"
#include "engine/hair_grid.h"
#include "engine/moving_body.h"
#include "engine/scratch.h"
#include "engine/state.h"
#include "engine/state_read.h"
#include "engine/strand_model.h"
#include "hairloom/engine.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Trusts the sizes of what it is given.
struct Engine::Impl : InMemory {
    struct Frame;
    struct BlockReport {
        std::array<std::uint64_t, kStageCount> nanoseconds{};
        float fastest = 0.0f;  ///< square metres, as Kernels::fastest
        std::uint32_t restored = 0, guarded = 0;
        bool rootsMoved = false;
        bool rootsTeleported = false;  ///< some are carried along rigidly
    };
    Impl(const StrandsView& strands, const SimulationSettings& settings, Host host);

    void reset(std::span<const RootFrame> roots_ws);
    void place(std::span<const RootFrame> roots_ws, std::span<const Float3> positions_ws,
               std::span<const Float3> velocities_ws, const std::optional<std::array<double, 3>>& origin_ws);
    void placeLane(std::size_t block, std::uint32_t lane, const Float3* positions_ws,
                   const Float3* velocities_ws);
    std::string setSettings(const SimulationSettings& settings);
    void setBody(std::shared_ptr<const BodyField> body);
    std::string setPoses(std::span<const PoseView> poses);
    void setPoseAmounts(std::span<const float> amounts);
    void followPoses(bool others);
    bool setState(const State& state);
    void step(const FrameInput& input);
    /// A frame without poses inside, in so many substeps or more.
    void stepStraight(const FrameInput& input, std::uint32_t substeps);
    void readRoots(Vector<RootFrame>& roots_ws) const;
    void addVelocities(std::span<const Float3> changes_ws);
    std::size_t effectBytes(Effect effect) const;
    std::size_t baseBytes() const;
    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(shape_->offsets.size() - 1); }
    std::uint32_t pointCount() const { return shape_->offsets.back(); }

    void replan(std::span<const Sphere> spheres, std::span<const Float3> sphereMotion, Float3 rootsMin_ws,
                Float3 rootsMax_ws, float frameTime);
    /// The same without memory.
    void plan(std::span<const Sphere> spheres, std::span<const Float3> sphereMotion, Float3 rootsMin_ws,
              Float3 rootsMax_ws, float frameTime);
    void allocateForPlan();
    void allocateForBody();
    bool meetsBody() const { return body_ && model().meetsBody; }
    const Model& model() const { return modelOf(settings_.strandModel); }
    void placeAtRest(std::size_t block, LaneRange lanes);
    void forBlocks(const std::function<void(std::size_t)>& each);
    void takeRoots(const FrameInput& input);
    void repairRoots(std::size_t block);
    std::uint32_t substepsOf(const FrameInput& input, std::uint32_t usual) const;
    void takeBody(const FrameInput& input);
    bool isWindy() const;
    void wakeBlocks();
    bool sphereNear(std::size_t block) const;
    Frame makeFrame(const FrameInput& input);
    BlockView& view(std::size_t block, BlockRoom& room);
    void runBlocks(const Frame& frame);
    void runBlock(std::size_t block, LaneFrame& lanes, const Frame& frame);
    void turnAlong(const BlockView& view, std::uint32_t lane, Quat turn) const;
    void teleportLanes(const BlockView& view, float* rows, const float* next) const;
    void moveOrigin(std::array<double, 3> origin_ws);
    void enterFrame(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame);
    static void openSubstep(SubstepContext& context, const Frame& frame);
    static void runPass(std::size_t i, const BlockView& view, LaneFrame& lanes, const SubstepContext& context,
                        const Frame& frame);
    void runStages(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame);
    void restoreStrands(std::size_t block, const BlockView& view);
    void rest(std::size_t block, const BlockView& view, const Frame& frame);
    void sumReports();

    SimulationSettings settings_;
    Host host_;
    std::shared_ptr<const RestShape> shape_;
    std::shared_ptr<const BodyField> body_;
    Floats clearances_;                 // of the body; empty without one
    Floats bodySeen_;                   // kBodyPlanes, per block
    bool bodyLost_ = true;              // what they say is void
    Vector<std::uint8_t> skinSpheres_;  // as Engine::setSkinSpheres() was told
    bool skinSpheresChanged_ = false;   // since the last frame
    BodyTable bodyTable_;
    Vector<std::uint32_t> bodyCarriers_;  // carriersOf()
    OwnedStrands strands_;                // as their model has them
    HairGrid hairGrid_;
    std::shared_ptr<const PoseSet> poses_;  // null: none
    Vector<float> poseAmounts_;
    EffectPlan plan_;
    FrameWind wind_;
    State state_;
    Scratch scratch_;
    bool keepsMemory_ = false;  // of effects that are off
    StepReport report_;
    Vector<BlockReport> blockReports_;
    // Of the frame under way.
    Floats nextRoots_;  // as State::roots, at the frame's end
    FrameSpheres spheres_;
    Vector<MovingSphere> movingSpheres_;
    std::size_t pressing_ = 0;  // of them, those that stand for no skin
    Vector<MovingCapsule> movingCapsules_;
    MovingBody movingBody_;
    bool bodyMoves_ = false;
    std::uint32_t substeps_ = 1;
    float rootMotion_ = 0.0f;        // metres, the longest way of a root
    float teleportDistance_ = 0.0f;  // metres; negative: everything that moves is cut
    FramePieces pieces_;
    Vector<RootFrame> rootsNow_;  // one per strand, where a piece needs them
};

/// What all blocks share in one step.
struct Engine::Impl::Frame : ModelFrame {
    const FrameInput* input;
    /// Of the wind at the end of each substep.
    std::array<std::array<float, kWindModes>, kMaxSubsteps> windPhases;
    const Kernels* kernels;
    Passes passes;  ///< of the plan; a call for each stage where there is a clock between them
};

}  // namespace hairloom::runtime
