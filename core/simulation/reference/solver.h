// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The reference for the strand engine: the model of docs/engine.md in scalar double precision, one strand
// after the other, sharing no code with it. It solves the model's equations of motion, not the engine's
// steps: with more substeps it converges to the true motion.
//
// Of the settings it reads what states the model; it chooses its own time steps and solves, so that
// integrator, substeps, the count of lengthIterations (0 still frees the lengths) and maximalExtension do not
// count, `implicit` springs are `smallAngle` ones, `springVelocities` are `springs`, and `backward` response
// is `radial`: they differ only by a step's length. Kelvin-Voigt damping of bending acts in both directions
// of angular springs. The wind is that of runtime/wind.h at each point itself. Does not do: maximal extension
// of springs, sleep, windShelter and collisionSegments, which it refuses; stiff hair that is pressed end-on
// or between two spheres, where lengths and hard contacts have no sound common solution: StepReport::failed
// tells.
//
// `strandModel` decides which model it is. Rods (rod_step.h) read none of the settings of lengths and
// angular springs, nor collisionResponse: contacts are springs whose stiffness grows with the square of the
// count of steps.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/simulation/reference/rod_step.h"
#include "core/simulation/reference/strand.h"
#include "core/simulation/reference/substep.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::reference {

/// As runtime::StrandsView.
struct Strands {
    std::vector<std::uint32_t> offsets;
    std::vector<Vec3d> restPositions_ss;        ///< m
    std::vector<Quaterniond> rootRotations_ss;  ///< empty: the identity
    std::vector<double> pointMasses;            ///< above 0, one per point; only ratios within a strand count
    std::vector<double> stiffness;              ///< of strands, times the settings'; empty: 1
};

struct Root {
    Vec3d position = Vec3d::Zero();
    Quaterniond rotation = Quaterniond::Identity();
};

struct Sphere {
    Vec3d center_ws = Vec3d::Zero();
    double radius = 0.0;
};

/// As runtime::FrameInput.
struct Frame {
    double dt = 1.0 / 60.0;        ///< s, above 0
    double time = 0.0;             ///< s, at the end of the frame
    std::vector<Root> roots_ws;    ///< one per strand
    std::vector<Sphere> spheres;   ///< of radius 0 or less: left out
    runtime::WindInput wind = {};  ///< what the frame gives in place of the settings' air
    std::vector<std::array<std::size_t, 2>> capsules = {};  ///< hulls of two of the spheres
};

Strands strandsOf(const runtime::StrandsView& view);
Frame frameOf(const runtime::FrameInput& input);

struct StepOptions {
    std::uint32_t substeps = 64;  ///< per frame, above 0
    /// 1, 2 or 4. 4 is five steps of order 2, one of them backwards in time (Suzuki 1990). Frames with
    /// spheres that respond by impulses are of order 1 either way; 4 takes steps of order 2 in them. 1, the
    /// implicit Euler method, brings strands to rest sooner, and leaves the position of rest as it is. Of
    /// rods: 1, 2 or 3 stages of Radau IIA collocation, which damp what is too fast for a step.
    int order = 4;
    /// Times that a step which cannot be solved is halved, with its halves; each costs twice the work.
    int halvings = 6;
};

/// How well the equations of a frame were solved.
struct StepReport {
    std::uint64_t steps = 0;
    std::uint64_t halved = 0;  ///< steps whose iteration did not converge and that were taken in halves
    /// Steps that did not converge, or whose lengths are off by 1e-12, even so: in them the strand goes along
    /// with its root, without speed.
    std::uint64_t failed = 0;
    double largestStretch = 0.0;      ///< ||e|/l − 1| at the end of the frame
    std::uint64_t contacts = 0;       ///< points that touched a sphere, summed over steps
    double deepestPenetration = 0.0;  ///< left after a step, m
    double fastestApproach = 0.0;     ///< left after a step, m/s
};

/// Joules for strands whose points have a mean mass of 1 kg.
struct Energy {
    double kinetic = 0, gravity = 0, springs = 0, angular = 0;
    double total() const { return kinetic + gravity + springs + angular; }
};

class Solver {
  public:
    /// Strands at rest in their rest positions. Errors: settings out of range, angularStiffness 1 (no finite
    /// stiffness), offsets that do not fit, a strand of fewer than 2 points, a segment without length, a
    /// value that is no number, masses that are not above 0.
    static Result<Solver> make(const Strands& strands, const runtime::SimulationSettings& settings,
                               BendingForce bendingForce = BendingForce::framesHeld);

    /// Rest shape on these roots, without speed.
    void reset(std::span<const Root> roots_ws);
    /// Places all points, with these speeds; clamped points keep their own. Where lengths are held the
    /// positions must have them; speeds lose what would change them.
    void setMotion(std::span<const Vec3d> positions_ws, std::span<const Vec3d> velocities_ws);
    StepReport step(const Frame& frame, const StepOptions& options = {});

    /// Strand after strand, root to tip; metres, world.
    std::vector<Vec3d> positions_ws() const;
    std::vector<Vec3d> velocities_ws() const;
    Energy energy() const;
    /// Shape, masses and stiffness of strand s.
    const StrandShape& shape(std::size_t s) const { return strands_[s].shape; }
    std::size_t strandCount() const { return strands_.size(); }

  private:
    struct Rod {
        RodShape shape;
        RodMotion motion;
        RodWorkspace work;
        void turn(const Quaterniond& by);
    };
    struct Strand {
        StrandShape shape;
        StrandState state;
        Root root;
        Workspace work;
        std::optional<Rod> rod;  // StrandModel::rods
    };

    Solver(const runtime::SimulationSettings& settings, BendingForce bendingForce)
        : settings_(settings), physics_(settings, bendingForce) {}
    std::vector<ColliderNow> collidersOf(const Frame& frame) const;
    void stepStrand(Strand& strand, const RootPath& path, const StepOptions& options,
                    StepReport& report) const;
    bool trySubstep(Strand& strand, const RootPath& path, double from, double to, double weight) const;
    void advanceRod(Strand& strand, const RootPath& path, double from, double to, int order,
                    StepReport& report, int halvings) const;
    static void carryAlong(Strand& strand, const RootPath& path, double from, double to);
    void advance(Strand& strand, const RootPath& path, double from, double to, double weight,
                 StepReport& report, int halvings) const;

    runtime::SimulationSettings settings_;
    Physics physics_;
    std::vector<Strand> strands_;
    std::vector<Root> restRoots_;
    std::vector<Sphere> spheres_;  // at the end of the last frame
};

}  // namespace hairloom::reference
