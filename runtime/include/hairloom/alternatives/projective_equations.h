// SPDX-License-Identifier: MIT
#pragma once
// One-dimensional projective equations (Anjyo, Usami, Kurihara 1992; Rünz 2012, Section 3.1 and Eq. 1), with
// what later work adds to them: hair that bends around the head, keeps its distance from other hair, and
// takes on a style (Lee and Ko 2001; Jung, Rettig, Klar and Lehr 2005).

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/alternatives/moving_spheres.h"
#include "hairloom/alternatives/near_sticks.h"
#include "hairloom/alternatives/stick.h"
#include "hairloom/host.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"
#include "hairloom/wind.h"

namespace hairloom::runtime {

struct WindyFrame;

/// Strands as chains of stiff sticks, each with an azimuth θ and an inclination φ about the frame that its
/// parent carries. Used as Engine is; the model in symbols is in docs/engine.md.
///
/// Length: a stick has a direction and no other freedom, so its length is its rest length to rounding.
///
/// Poles: the polar axis stands across the rest direction and level in the rest pose, so that gravity turns
/// hair in θ and the poles lie sideways, a quarter turn away from rest. Angles keep counting across a pole
/// and the frame turns smoothly with them; but at a pole a force across the meridian finds no lever, so there
/// a stick only swings along its meridian.
///
/// Stability: each angle takes a linearly implicit Euler step whose slope is no smaller than that of the
/// torque anywhere, so that under forces that rest a step of any size cannot raise ½(θ'² + φ'²) plus the
/// potential of the forces; and no angle turns by more than a quarter turn in a substep, whatever the forces.
/// The price is numerical damping, at about h/2 · (largest slope) per second.
///
/// Limits: a stick feels its own weight, the air and the acceleration of its root, but nothing of the sticks
/// beyond it. A strand therefore swings as fast as one of its sticks, faster with more segments, and sags
/// less than a rod of the same stiffness. No torsion. Away from the equator of its
/// polar system θ lags by cos²φ (the inertia in Eq. 1 is constant). Collision pushes the tips of sticks out
/// of one sphere after the other, without friction, rebound or impulse from the sphere; a stick whose whole
/// reach lies inside a sphere points away from its centre. Of the settings it ignores integrator,
/// lengthMethod, lengthIterations, maximalExtension, springFrequency, angularMethod, collisionResponse,
/// friction, restitution, penaltyFrequency, sleep, and of hair-hair collision friction and cohesion.
///
/// Hair-hair collision (SimulationSettings::hairHair): the tip of a stick is turned out of the reach of the
/// sticks of other strands that NearSticks finds at the start of a frame, evenly over its substeps, by the
/// share hairHairStrength, and stops moving towards them. Its reach is hairHairCell. Spheres come after hair
/// and win. Sticks that pass through each other within a frame are not seen.
class ProjectiveEquations {
  public:
    struct Result;
    /// Strands at rest in their rest positions. Errors, in words, as Engine::make.
    static Result make(const StrandsView& strands, const SimulationSettings& settings, Host host = {});

    // Calls that are given arrays return false, and do nothing, where one has the wrong size.

    /// Places all strands in their rest shape on these roots, without speed. One root per strand.
    bool reset(std::span<const RootFrame> roots_ws);
    /// From the next step on; empty, or why they are refused.
    std::string setSettings(const SimulationSettings& settings);
    /// The shape that sticks turn to from the next step on, in place of the authored one: target angles of
    /// each strand, of at most kMostStyled from the authored ones at each stick (a later stick makes up for
    /// the rest). Metres, in the scalp's rest space, by point. Empty: as authored. Errors,
    /// in words, which change nothing: another number of points, points that are no numbers, other roots or
    /// lengths.
    std::string setStyle(std::span<const Float3> restPositions_ss);
    /// Advances by input.dt. A dt that is not above 0 changes nothing, one above 1000 s counts as 1000 s;
    /// roots that are no position within 1e6 m stay where they were; spheres that are none are left out.
    /// Allocates only for more spheres than ever before, and while hair meets hair.
    bool step(const FrameInput& input);

    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(roots_.size()); }
    std::uint32_t pointCount() const { return offsets_.back(); }
    /// In the order given to make(); metres, world. Size pointCount().
    bool readPositions(std::span<Float3> positions_ws) const;
    /// In the same order; metres per second over the last substep.
    bool readVelocities(std::span<Float3> velocities_ws) const;

  private:
    struct Root {
        RootFrame rest, now;
        Float3 velocity;         ///< over the last frame
        float stiffness = 1.0f;  ///< of the strand, as StrandsView has it
    };
    struct Substep;
    ProjectiveEquations() = default;

    void fillSticks();
    void runStrand(std::uint32_t strand, const WindyFrame& frame);
    void runSubstep(std::uint32_t strand, const Substep& substep);
    StickForces forcesOn(std::uint32_t point, Quat frame, float along, const Substep& substep) const;
    void collide(std::uint32_t point, Quat frame, float along, const Substep& substep);
    void keepApart(std::uint32_t point, Quat frame, const Substep& substep, NearSticks::Away& carried);
    void findNearHair();

    SimulationSettings settings_;
    Host host_;
    Wind wind_;
    std::vector<std::uint32_t> offsets_;
    std::vector<Root> roots_;           // by strand
    std::vector<Stick> sticks_;         // by point
    std::vector<StickMotion> motions_;  // by point
    std::vector<Float3> positions_;     // by point, from the root, world axes
    std::vector<Float3> velocities_;    // by point, world
    MovingSpheres spheres_;
    std::vector<Float3> rest_;  // by point, scalp's rest space
    std::vector<Float3>
        styles_;       // segments of the style, by outer point, in the root's rest frame; empty: none
    NearSticks near_;  // while hair meets hair
    std::vector<Float3> starts_ws_;  // likewise, by point
};

struct ProjectiveEquations::Result {
    std::optional<ProjectiveEquations> engine;
    std::string error;  ///< empty when there is an engine
};

}  // namespace hairloom::runtime
