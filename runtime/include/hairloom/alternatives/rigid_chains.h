// SPDX-License-Identifier: MIT
#pragma once
// Strands as serial chains of rigid bodies (Hadap and Magnenat-Thalmann 2001, "Modeling dynamic hair as a
// continuum"; Rünz 2012, Section 3.1), by Featherstone's articulated-body algorithm.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/alternatives/moving_spheres.h"
#include "hairloom/host.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"
#include "hairloom/wind.h"

namespace hairloom::runtime {

struct WindyFrame;

/// Each segment is a thin rigid rod that hangs on its parent by a ball joint, with a spring towards the rest
/// shape and a damper. Used as Engine is; the model in symbols is in docs/engine.md.
///
/// Length: segments are rigid, so lengths are those at rest to rounding, without a constraint.
///
/// Solution: the accelerations of all joints at once, in time linear in the segments (Featherstone 1983), in
/// double precision. Springs, dampers, air and the turning moment of gravity are linearly implicit: the
/// algorithm takes them as inertia of joints and bodies.
///
/// Stability: the new motion is the one nearest to the last substep's, measured by kinetic energy, so that
/// neither it nor a force at rest adds energy, whatever the step. The price is numerical damping of first
/// order in the step.
///
/// Limits: a joint is as stiff in twist as in bending, and a segment has an inertia about its axis (a
/// thousandth of m l²) that a hair does not have. Collision turns segments whose tips are in a sphere about
/// their joints, one sphere after the other, without friction or rebound, and tells the rest of the chain
/// only by where it now hangs. No hair against hair. Of the settings it ignores those that
/// ProjectiveEquations ignores, torsionRatio and sectionRatio.
class RigidChains {
  public:
    struct Result;
    /// Strands at rest in their rest positions. Errors, in words, as Engine::make.
    static Result make(const StrandsView& strands, const SimulationSettings& settings, Host host = {});

    // Calls that are given arrays return false, and do nothing, where one has the wrong size.

    /// Places all strands in their rest shape on these roots, without speed. One root per strand.
    bool reset(std::span<const RootFrame> roots_ws);
    /// From the next step on; empty, or why they are refused.
    std::string setSettings(const SimulationSettings& settings);
    /// Advances by input.dt. A dt that is not above 0 changes nothing, others count as 10⁻⁶…1000 s; roots
    /// that are no position within 1e6 m stay where they were; spheres that are none are left out.
    /// Allocates only for more spheres than ever before.
    bool step(const FrameInput& input);

    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(roots_.size()); }
    std::uint32_t pointCount() const { return offsets_.back(); }
    /// In the order given to make(); metres, world. Size pointCount().
    bool readPositions(std::span<Float3> positions_ws) const;
    /// In the same order; metres per second.
    bool readVelocities(std::span<Float3> velocities_ws) const;

  private:
    struct Root {
        RootFrame rest, now;
        Float3 velocity;         ///< over the last frame
        Float3 turning;          ///< 1/s, over the last substep, world axes
        float stiffness = 1.0f;  ///< of the strand, as StrandsView has it
    };
    /// A segment, kept with its outer point.
    struct Segment {
        Float3 along;            ///< rest direction in the root's rest frame, of unit length
        float length = 0.0f;     ///< metres, and its mass: hair weighs 1 per metre
        float stiffness = 0.0f;  ///< of its inner joint, moment per radian: m³/s²
        Quat aim;                ///< turn against its parent to which the joint's spring alone would take it
        bool fixed = false;      ///< goes with its parent
    };
    struct Motion {
        Quat rotation;      ///< of the rest frame of the root, in the world
        Float3 turning;     ///< 1/s, world axes
        Float3 axisBefore;  ///< the segment's direction before the last substep, world axes
    };
    struct Substep;
    struct Body;
    RigidChains() = default;

    void fillSegments();
    void aimAgainst(std::uint32_t strand, Float3 gravity);
    void runStrand(std::uint32_t strand, const WindyFrame& frame, std::vector<Body>& bodies);
    void runSubstep(std::uint32_t strand, const Substep& substep, std::span<Body> bodies);
    void gatherForces(std::uint32_t strand, const Substep& substep, std::span<Body> bodies) const;
    void eliminate(std::uint32_t strand, const Substep& substep, std::span<Body> bodies) const;
    void accelerate(std::uint32_t strand, const Substep& substep, std::span<const Body> bodies);
    void move(std::uint32_t strand, const Substep& substep);
    void collide(std::uint32_t point, float along, const Substep& substep);

    SimulationSettings settings_;
    Host host_;
    Wind wind_;
    std::vector<std::uint32_t> offsets_;
    std::vector<Root> roots_;         // by strand
    std::vector<Segment> segments_;   // by point
    std::vector<Motion> motions_;     // by point
    std::vector<Float3> positions_;   // by point, from the root, world axes
    std::vector<Float3> velocities_;  // by point, against the root's, world axes
    MovingSpheres spheres_;
};

struct RigidChains::Result {
    std::optional<RigidChains> engine;
    std::string error;  ///< empty when there is an engine
};

}  // namespace hairloom::runtime
