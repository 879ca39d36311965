// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs the strand engine, or an alternative to it, on a groom: roots follow the posed scalp, settings and
// spheres come from the groom.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/simulation/motion.h"
#include "hairloom/alternatives/hair_volume.h"

namespace hairloom::runtime {
struct State;
}

namespace hairloom {

/// What an effect is doing and what it costs.
struct EffectReport {
    std::string name;
    bool on;
    std::string why;  ///< "no sphere within reach of a strand"
    /// Per frame, mean since the start; 0 while off. Absent where it has no time of its own: rods solve all
    /// effects of a strand at once, and measuring the hair without it (core/cost/effect_cost.h) prices it.
    std::optional<double> milliseconds;
    std::uint64_t bytes;  ///< memory of its own; 0 while off
};

struct SimulationStats {
    std::uint64_t frames = 0;
    double millisecondsPerFrame = 0;  ///< mean
    double nanosecondsPerParticleSubstep = 0;
    double maxStretch = 0;        ///< largest |length / rest length − 1| of a segment, over all frames
    double maxPenetrationMm = 0;  ///< deepest point inside a sphere after a frame, over all frames
    double energy = 0;  ///< kinetic energy after the last frame, joules for strands of unit mass per point
    std::uint64_t nanCount = 0;         ///< points that are not finite, over all frames
    std::uint64_t restoredStrands = 0;  ///< put back to rest because they exploded, over all frames
    std::uint64_t guardedStrands = 0;   ///< whose speeds were taken back, over all frames
    std::uint64_t restingStrands = 0;   ///< asleep after the last frame
    double fastestMmPerSecond = 0;      ///< of a point, after the last frame
    std::uint64_t stateHash = 0;        ///< equal for any number of threads
    std::vector<EffectReport> effects;
};

/// How strands move (Rünz 2012, Section 3.1); docs/methods.md compares them.
enum class SimulationMethod {
    strands,     ///< the strand engine
    projective,  ///< runtime/alternatives/projective_equations.h
    chain,       ///< runtime/alternatives/rigid_chains.h
    lattice,     ///< runtime/alternatives/lattice.h: lengths are not held
    particles,   ///< the strand engine, and hair_particles.h between its frames
    hybrid,      ///< likewise, with hair_flow.h
};

class SceneInput;
class StrandMethod;
/// Makes what moves the strands of a scene (core/simulation/strand_method.h).
using MethodMaker = std::function<Result<std::unique_ptr<StrandMethod>>(
    const SceneInput& scene, const std::optional<runtime::HairVolumeSettings>& hairVolume)>;

struct SimulationOptions {
    SimulationMethod method = SimulationMethod::strands;
    /// Hair against hair between frames; for methods that take velocities.
    std::optional<runtime::HairVolumeSettings> hairVolume = {};
    /// What runs the strand engine, in place of the CPU; empty: the CPU.
    MethodMaker backend = {};
};

class Simulation {
  public:
    /// The groom's strands at rest on `start`. Errors: no strands, a groom that validate() finds errors in,
    /// settings out of range, hair against hair for a method that takes no velocities.
    static Result<Simulation> make(const Groom& groom, const HeadPose& start,
                                   const SimulationOptions& options = {});
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    /// Other settings from the next step on, without a jump; wind is one of them. Errors, which leave all as
    /// it was: settings out of range, a method other than the strand engine on the CPU.
    Status setSettings(const runtime::SimulationSettings& settings);
    /// How far strands follow each of the groom's poses from the next step on, in place of the authored
    /// amounts; a pose of the head that has amounts comes before. Errors, which leave all as it was: another
    /// number than there are poses, a method that follows none.
    Status setPoseAmounts(std::span<const float> amounts);
    /// The shape that strands turn to from the next step on, in place of the authored one: of the same
    /// strands on the same roots, in the order of the groom's points; metres, at rest. Errors, which leave
    /// all as it was: another number of points, other roots or lengths, a method that has no angles to aim
    /// at.
    Status setStyle(std::span<const Vec3f> restPositions);
    /// Collision spheres in place of the groom's, from the next step on. `atRest`: where they are while the
    /// head is at rest, which shows what they represent; others push hair, be they in the skin or not.
    void setSpheres(std::vector<CollisionSphere> spheres, bool atRest = true);

    /// Advances by `dt` seconds (0 < dt ≤ 0.1) to `pose`. `within`: poses on the way there, at equal shares
    /// of dt, at most runtime::kMaxInnerPoses; methods other than the strand engine see the end alone.
    void step(float dt, const HeadPose& pose, std::span<const HeadPose> within = {});
    void step(float dt, const HeadStep& head) { step(dt, head.end, head.within); }

    /// Points in the order of the groom's points; metres, world space.
    std::span<const Vec3f> positions_ws() const;
    /// m/s after the last step, likewise; read when asked. Empty before it, and where the method knows none.
    std::vector<Vec3f> velocities_ws() const;
    /// What changes from step to step, for another simulation of the same strands to go on from; null for a
    /// method that cannot tell.
    std::shared_ptr<const runtime::State> state() const;
    /// At `time` seconds. False, and nothing is changed, where it cannot go on from there.
    bool setState(const runtime::State& state, double time);
    SimulationStats stats() const;
    /// What went wrong outside of the strands, such as a device that was lost; the frames since then are
    /// void.
    Status status() const;

  private:
    struct Impl;
    explicit Simulation(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// The groom as it stands in a pose: strands at `positions_ws`, scalp and spheres moved with them. It has no
/// body, which is baked at rest.
Groom posedGroom(const Groom& groom, std::span<const Vec3f> positions_ws, const HeadPose& pose);

}  // namespace hairloom
