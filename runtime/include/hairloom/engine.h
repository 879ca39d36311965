// SPDX-License-Identifier: MIT
#pragma once
// The strand engine. Authored settings, the plan and the state are three things with three lifetimes: the
// settings are given, the plan is made from them each frame, and the state is what an Engine owns.
//
// docs/engine.md has the model in symbols. Does not do: hair against hair (alternatives/hair_volume.h does,
// between frames), twist of a strand about itself, collision between points.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/frame_setup.h"
#include "hairloom/host.h"
#include "hairloom/plan.h"
#include "hairloom/settings.h"
#include "hairloom/state.h"
#include "hairloom/state_read.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// What the last step took. Times are sums over threads, all 0 without Host::nanoseconds.
struct StepReport {
    std::array<double, kStageCount> stageMilliseconds{};  ///< by StageId
    double milliseconds = 0.0;                            ///< from entering to leaving step()
    std::uint32_t rejectedRoots = 0;    ///< roots that were not finite; they stayed where they were
    std::uint32_t rejectedSpheres = 0;  ///< spheres that were not finite or had no radius; they were left out
    std::uint32_t rejectedWinds = 0;  ///< wind_ws and actorVelocity_ws that were not finite or above 1000 m/s
    /// Strands with a point that was no number, or farther from its root than any hair; they were put back to
    /// rest.
    std::uint32_t restoredStrands = 0;
};

class Engine {
  public:
    struct Made;
    /// Strands at rest in their rest places. Errors, in words: settings out of range, offsets that do not
    /// match the points, a strand of fewer than 2 or more than kMaxPoints points, a rest position or rotation
    /// that is no number.
    static Made make(const StrandsView& strands, const SimulationSettings& settings, Host host = {});

    /// Places all strands in their rest shape on these roots, without speed. One root per strand.
    void reset(std::span<const RootFrame> roots_ws);
    /// Takes other settings from the next step on; empty, or why they are refused. May allocate; step() does
    /// not, but for more spheres than ever before.
    std::string setSettings(const SimulationSettings& settings);
    const SimulationSettings& settings() const { return settings_; }

    /// Advances by input.dt to the end of the frame. A dt that is not above 0 changes nothing.
    void step(const FrameInput& input);

    /// Changes velocities between frames, as hair against hair does (alternatives/hair_volume.h): one change
    /// in m/s per point, in the order of make(). Those of clamped points and those that are not finite are
    /// left out. Strands that are changed wake up. Before the first step it does nothing.
    void addVelocities(std::span<const Float3> changes_ws);

    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(shape_->offsets.size() - 1); }
    std::uint32_t pointCount() const { return shape_->offsets.back(); }
    /// Strand after strand, root to tip, in the order that make() was given; metres, world. Size
    /// pointCount().
    void readPositions(std::span<Float3> positions_ws) const;
    /// In the same order, metres per second over the last substep.
    void readVelocities(std::span<Float3> velocities_ws) const;

    /// The plan of the last step, or of the strands at rest before the first.
    const EffectPlan& plan() const { return plan_; }
    const StepReport& lastStep() const { return report_; }
    Measurements measure() const;
    /// Memory that exists because of this effect; 0 while it is off.
    std::size_t effectBytes(Effect effect) const;
    /// Memory of strands, roots and bookkeeping.
    std::size_t baseBytes() const;
    /// Of all positions and speeds; equal for any number of threads, and for all instruction sets that have
    /// fused multiply-add as for all that have not.
    std::uint64_t stateHash() const { return state_.hash(); }
    /// Name of the instruction set in use.
    static const char* instructionSet();

  private:
    struct Frame;
    struct BlockReport {
        std::array<std::uint64_t, kStageCount> nanoseconds{};
        float fastest = 0.0f;  ///< square metres, as Kernels::fastest
        std::uint32_t restored = 0;
        bool rootsMoved = false;
        bool rootsCut = false;  ///< some are carried along rigidly
    };
    Engine() = default;

    void replan(std::span<const Sphere> spheres, std::span<const Float3> sphereMotion, Float3 rootsMin_ws,
                Float3 rootsMax_ws, float frameTime);
    void allocateForPlan();
    void takeRoots(const FrameInput& input);
    void repairRoots(std::size_t block);
    void wakeBlocks();
    bool sphereNear(std::size_t block) const;
    Frame makeFrame(const FrameInput& input);
    BlockView view(std::size_t block);
    void runBlock(std::size_t block, const Frame& frame);
    static void turnAlong(const BlockView& view, std::uint32_t lane, Quat turn);
    void cutLanes(const BlockView& view, float* rows, const float* next) const;
    void enterFrame(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame);
    void runStages(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame);
    void restoreStrands(std::size_t block, const BlockView& view);
    void rest(std::size_t block, const BlockView& view, const Frame& frame);
    void sumReports();

    SimulationSettings settings_;
    Host host_;
    std::shared_ptr<const RestShape> shape_;
    EffectPlan plan_;
    FrameWind wind_;
    State state_;
    Bend bend_;
    Floats evaluation_;  // empty for position Verlet
    std::size_t evaluationPlanes_ = 0;
    StepReport report_;
    std::vector<BlockReport> blockReports_;
    // Of the frame under way.
    Floats nextRoots_;  // as State::roots, at the frame's end
    FrameSpheres spheres_;
    std::vector<MovingSphere> movingSpheres_;
    float rootMotion_ = 0.0f;  // metres, the longest way of a root
};

struct Engine::Made {
    std::optional<Engine> engine;
    std::string error;  ///< empty when there is an engine
};

}  // namespace hairloom::runtime
