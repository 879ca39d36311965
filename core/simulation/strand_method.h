// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What Simulation asks of a way to move strands: the engine, or one of the methods in runtime/alternatives.

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/simulation/scene_input.h"
#include "core/simulation/simulation.h"
#include "hairloom/alternatives/hair_volume.h"
#include "hairloom/alternatives/lattice.h"
#include "hairloom/engine.h"

namespace hairloom {

/// Threads and clock of this program.
runtime::Host applicationHost();

/// "off, no sphere within reach of a strand" out of "collision: off, …".
std::string reasonAlone(const std::string& why);

class StrandMethod {
  public:
    virtual ~StrandMethod() = default;
    virtual void reset(const SceneInput& scene, const HeadPose& pose) = 0;
    /// Advances to `pose`; `input` holds its roots and spheres.
    virtual void step(const SceneInput& scene, const HeadPose& pose, const runtime::FrameInput& input) = 0;
    /// Measured from the origin of the last step, where measuresFromOrigin(), else from that of the world.
    virtual void readPositions(std::span<runtime::Float3> positions_ws) const = 0;
    /// m/s, in the order of the points. False, and nothing is written, where the method knows none.
    virtual bool readVelocities(std::span<runtime::Float3>) const { return false; }
    /// Takes poses whose positions are measured from an origin of theirs.
    virtual bool measuresFromOrigin() const { return false; }
    /// Of the last step.
    virtual double stepMilliseconds() const = 0;
    /// Of the last step, where it does not take those of the settings.
    virtual std::optional<std::uint32_t> substeps() const { return std::nullopt; }
    /// The first thing that went wrong outside of the strands: a device that was lost, say.
    virtual Status status() const { return {}; }
    /// Strands that the last step put back to rest because they were no numbers.
    virtual std::uint32_t restoredStrands() const { return 0; }
    /// Strands whose speeds the last step took back because no force explains them.
    virtual std::uint32_t guardedStrands() const { return 0; }
    /// Other settings from the next step on, without a jump. An error leaves all as it was.
    virtual Status setSettings(const runtime::SimulationSettings&) {
        return fail("this method cannot change settings while it runs");
    }
    /// The shape that strands turn to from the next step on, by point, in place of the authored one. An error
    /// leaves all as it was.
    virtual Status setStyle(std::span<const runtime::Float3>) {
        return fail("this method takes no style while it runs", "expected the method 'projective'");
    }
    /// Of the groom's poses, from the next step on. An error leaves all as it was.
    virtual Status setPoseAmounts(std::span<const float> amounts);
    /// All that changes from step to step, for another engine to go on from (runtime::Engine::state()); null
    /// where it cannot be had.
    virtual std::shared_ptr<const runtime::State> state() const { return nullptr; }
    /// False, and nothing is changed, where it cannot go on from there.
    virtual bool setState(const runtime::State&) { return false; }
    virtual runtime::Measurements measure() const = 0;
    virtual std::uint64_t stateHash() const = 0;
    /// With the mean time of each since the start.
    virtual std::vector<EffectReport> effects() const = 0;
};

/// The strand engine.
Result<std::unique_ptr<StrandMethod>> makeEngineMethod(
    const SceneInput& scene, const std::optional<runtime::HairVolumeSettings>& hairVolume);
/// The strand engine with hair as a continuum between its frames, in place of simulation.hairHair: particles
/// or a hybrid of grid and strands.
Result<std::unique_ptr<StrandMethod>> makeParticleMethod(const SceneInput& scene);
Result<std::unique_ptr<StrandMethod>> makeHybridMethod(const SceneInput& scene);
Result<std::unique_ptr<StrandMethod>> makeProjectiveMethod(const SceneInput& scene);
Result<std::unique_ptr<StrandMethod>> makeChainMethod(const SceneInput& scene);
Result<std::unique_ptr<StrandMethod>> makeLatticeMethod(const SceneInput& scene);

/// Which forces of a groom's settings a lattice can have: gravity, air with the mean wind, damping.
/// Attachment and coupling have no counterpart there and keep their defaults.
runtime::LatticeSettings latticeSettings(const runtime::SimulationSettings& settings);

/// A solver that hair around a strand can push: `changes_ws`, metres per second, one per point in the order
/// of the points; clamped points stay where they are.
template <class Solver>
concept TakesVelocities = requires(Solver& solver, const Solver& reads, std::span<runtime::Float3> values,
                                   std::span<const runtime::Float3> changes_ws) {
    { reads.pointCount() } -> std::convertible_to<std::size_t>;
    reads.readPositions(values);
    reads.readVelocities(values);
    solver.addVelocities(changes_ws);
};

/// Hair against hair between the frames of a solver. `Medium`: HairVolume, HairParticles or HairFlow.
template <TakesVelocities Solver, class Medium>
typename Medium::Report pushHairApart(Solver& solver, Medium& volume, float dt) {
    std::vector<runtime::Float3> positions(solver.pointCount()), before(positions.size());
    solver.readPositions(positions);
    solver.readVelocities(before);
    std::vector<runtime::Float3> after = before;
    const auto report = volume.apply(positions, after, dt);
    for (std::size_t p = 0; p < after.size(); ++p) after[p] = after[p] - before[p];
    solver.addVelocities(after);
    return report;
}

}  // namespace hairloom
