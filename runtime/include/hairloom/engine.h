// SPDX-License-Identifier: MIT
#pragma once
// The strand engine. Authored settings, the plan and the state are three things with three lifetimes: the
// settings are given, the plan is made from them each frame, and the state is what an Engine owns.
//
// Stack: at most kStackBytes in any call, of the thread that makes it and of those that Host::parallelFor
// lends.
//
// docs/engine.md has the model in symbols. Hair meets hair on a grid alone, and only rods do
// (SimulationSettings::hairHair): single strands pass through each other.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/host.h"
#include "hairloom/plan.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Of a thread's stack that a call into the engine takes at most.
inline constexpr std::size_t kStackBytes = 64 * 1024;

/// What the state looks like; taken when asked for, at about the cost of one substep.
struct Measurements {
    std::uint64_t nanCount = 0;  ///< points that are not finite
    double maxStretch = 0.0;  ///< largest |length / rest length − 1|; segments without length do not count
    double maxPenetration =
        0.0;  ///< metres that a free point, with its collision radius, lies inside a sphere of the last frame
    double kineticEnergy = 0.0;  ///< joules, over free points; the points of a strand weigh 1 kg on average
    double potentialEnergy =
        0.0;                   ///< joules, likewise, in the gravity of the settings, 0 at the world's origin
    double fastest = 0.0;      ///< m/s, greatest speed of a free point over the last substep
    std::uint32_t asleep = 0;  ///< strands
};

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
    /// Rods whose speeds no force explains: more energy than before on a head at rest. It was taken out of
    /// them.
    std::uint32_t guardedStrands = 0;
    /// That the step took: those of the settings, more where a body or hair beside it is fast.
    std::uint32_t substeps = 0;
};

/// What changes from step to step (src/state.h): for those who go on elsewhere, as the engine on a GPU does.
struct State;
/// What strands are at rest, and how they are grouped (src/state.h).
struct RestShape;
/// Poses that strands follow, laid out alike (src/poses.h).
struct PoseSet;

class Engine {
  public:
    struct Result;
    /// Strands at rest in their rest positions. Errors, in words: settings out of range, offsets that do not
    /// match the points, a strand of fewer than 2 or more than kMaxPoints points, a rest position or rotation
    /// that is no number.
    static Result make(const StrandsView& strands, const SimulationSettings& settings, Host host = {});
    /// A copy is a snapshot: running on from it gives the same bits. An engine that was moved from can only
    /// be assigned to.
    Engine(const Engine& other);
    Engine(Engine&& other) noexcept;
    Engine& operator=(Engine other) noexcept;
    ~Engine();

    // Calls that are given arrays return false, and do nothing, where one has the wrong size.

    /// Places all strands in their rest shape on these roots, without speed. One root per strand.
    bool reset(std::span<const RootFrame> roots_ws);
    /// Goes on from strands that something else has moved: points at these positions with these speeds (one
    /// of each point, in the order of make(); metres and m/s, world), on these roots, without twist beyond
    /// that at rest. A strand with a value that is not finite is placed at rest. `origin_ws` is what they are
    /// measured from; without, what the next step's frame is measured from.
    bool place(std::span<const RootFrame> roots_ws, std::span<const Float3> positions_ws,
               std::span<const Float3> velocities_ws,
               const std::optional<std::array<double, 3>>& origin_ws = std::nullopt);
    /// Takes other settings from the next step on; empty, or why they are refused. May allocate; step() does
    /// not, but for more spheres than ever before and for effects that it has not met.
    std::string setSettings(const SimulationSettings& settings);
    const SimulationSettings& settings() const;

    /// A body that rods meet from the next step on, as they meet spheres; null: none. Points come no farther
    /// out of it than they were authored. Springs pass through it. Empty, or BodyField::problem().
    std::string setBody(std::shared_ptr<const BodyField> body);

    /// Of each sphere of the frames that follow, 1 where it stands for the skin of the body, as
    /// spheresOfSkin() tells: what meets the body passes through it, and it keeps off wind alone. Empty, and
    /// in frames with another number of spheres: none does.
    void setSkinSpheres(std::span<const std::uint8_t> ofSkin);

    /// Poses in place of those before, which rods follow by their amounts, 0 at first
    /// (FrameInput::poseAmounts); none: empty. Springs follow none. Empty, or why they are refused: more than
    /// kMaxPoses, another number of points or weights than the strands', a position that is no number within
    /// 1e6 m, a weight outside 0 … 1.
    std::string setPoses(std::span<const PoseView> poses);
    /// As FrameInput::poseAmounts sets them, at once; false for another number than there are poses.
    bool setPoseAmounts(std::span<const float> amounts);
    std::span<const float> poseAmounts() const;
    /// Those of setPoses(); copies of an engine share them. Null: none.
    std::shared_ptr<const PoseSet> poses() const;

    /// Memory that the body and what is known of it take; 0 where there is none, or springs pass through it.
    std::size_t bodyBytes() const;

    /// Memory of an effect that goes off stays, for the frame in which it comes back.
    void keepMemory();

    /// Host::nanoseconds from the next step on.
    void setClock(std::function<std::uint64_t()> nanoseconds);

    /// Advances by input.dt to the end of the frame. A dt that is not above 0 changes nothing. One root per
    /// strand, in poses inside the frame as well.
    bool step(const FrameInput& input);

    /// Changes velocities between frames, as a HairVolume does (alternatives/hair_volume.h): one change
    /// in m/s per point, in the order of make(). Those of clamped points and those that are not finite are
    /// left out. Strands that are changed wake up. Before the first step it does nothing.
    bool addVelocities(std::span<const Float3> changes_ws);

    /// Of make(); copies of an engine share it.
    std::shared_ptr<const RestShape> restShape() const;
    /// A copy.
    std::shared_ptr<const State> state() const;
    /// Goes on from the state of another engine of as many strands of as many points; positions and
    /// velocities are kept, and the rest as far as both engines keep it. False, and nothing is changed, for
    /// other strands.
    bool setState(const State& state);

    std::uint32_t strandCount() const;
    std::uint32_t pointCount() const;
    /// Strand after strand, root to tip, in the order that make() was given; metres, world. Size
    /// pointCount().
    bool readPositions(std::span<Float3> positions_ws) const;
    /// In the same order, metres per second over the last substep.
    bool readVelocities(std::span<Float3> velocities_ws) const;

    /// The plan of the last step, or of the strands at rest before the first.
    const EffectPlan& plan() const;
    const StepReport& lastStep() const;
    /// Strands that sleep; unlike measure(), at no cost to speak of.
    std::uint32_t asleep() const;
    Measurements measure() const;
    /// Memory that exists because of this effect; 0 while it is off.
    std::size_t effectBytes(Effect effect) const;
    /// Memory of strands, roots and bookkeeping, and of what threads work in.
    std::size_t baseBytes() const;
    /// Of all positions and speeds; equal for any number of threads, and for all instruction sets that have
    /// fused multiply-add as for all that have not.
    std::uint64_t stateHash() const;
    /// Name of the instruction set in use.
    static const char* instructionSet();

  private:
    struct Impl;
    explicit Engine(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

struct Engine::Result {
    std::optional<Engine> engine;
    std::string error;  ///< empty when there is an engine
};

}  // namespace hairloom::runtime
