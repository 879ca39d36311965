// SPDX-License-Identifier: MIT
#pragma once
// A free-form deformation lattice around the head, after Volino and Magnenat-Thalmann 2004, "Animating
// complex hairstyles in real-time" (Rünz 2012, Section 3.1).

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/host.h"
#include "hairloom/math.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Ranges stand behind each field; Lattice::make refuses what lies outside.
struct LatticeSettings {
    std::uint32_t nodes = 6;  ///< 3…16 control points along each axis. More: finer motion, nodes³ the cost
    float rootFrequency = 8.0f;      ///< Hz, 0.1…1000. Attachment to the head where there are roots only
    float tipFrequency = 1.5f;       ///< Hz, 0.1…1000. Attachment where there are tips only
    float couplingFrequency = 2.0f;  ///< Hz, 0…1000. Springs between neighbouring control points
    float dampingTime = 0.3f;  ///< seconds, 0…100, until motion against the head falls to 1/e; 0: undamped
    float airDrag = 1.0f;      ///< 1/s, 0…1000. Rate at which hair takes on the velocity of the air
    Float3 wind;               ///< m/s, each component −200…200
    Float3 gravity{0.0f, -9.81f, 0.0f};  ///< m/s², each component −1000…1000
    float teleportDistance =
        2.0f;  ///< metres, 0.01…10000. A head that moves farther carries the lattice along
    std::uint32_t substeps = 2;        ///< 1…64
    std::uint32_t clampedPoints = 1;   ///< 1…2 points of a strand, from its root, that spheres do not move
    float collisionRadiusRoot = 0.0f;  ///< metres, 0…0.1: distance from spheres at the root
    float collisionRadiusTip = 0.0f;   ///< metres, 0…0.1: at the tip, linear between them
};

/// Hair of distant characters: a box of nodes³ control points around the hair at rest, a damped mass-spring
/// system that hangs on the head, and hair that follows it through uniform quadratic B-splines, as in the
/// paper: each point is moved by 27 control points, smoothly, and affine deformations come through exactly.
///
/// A control point of mass 1 is attached to its rest position on the head by a spring whose frequency goes
/// from rootFrequency to tipFrequency with the mean place along the strands of the hair around it
/// (rootFrequency where there is none), and coupled to its six neighbours. The springs act on displacements
/// from the rigidly moved rest shape, so rigid motion deforms nothing; gravity acts by its turn against the
/// head, because the authored shape already hangs in it.
///
/// Stability: an implicit Euler step, which is linear here, by conjugate gradients. They start from no motion
/// against the head and minimise the energy of the step, so that after any number of iterations the lattice
/// has no more energy than before: any frame time, any stiffness.
///
/// Collision: what points of hair lack to be outside of the spheres moves the control points around them, by
/// the multilevel approximation of Lee, Wolberg, Shin 1997, and stops their motion inwards, once a step. What
/// a cell is too coarse for is placed on the sphere by evaluate(). Roots stay.
///
/// Cost: without spheres a step works on control points only, whatever the number of hairs. With some it
/// places every point once more; evaluate() is linear in points.
///
/// Limits: hair is a continuous medium here: no single wisps, no hair against hair; strands do not keep their
/// length; roots leave the scalp by as much as the lattice around them is deformed. The lattice differs from
/// the paper's, whose elasticity comes from the strands in each cell and whose control points collide with
/// metaballs.
class Lattice {
  public:
    struct Result;
    /// Box and coordinates from the strands at rest, around a head whose rest pose is the identity. Errors,
    /// in words: settings out of range, strands as Engine::make, no strands at all.
    static Result make(const StrandsView& strands, const LatticeSettings& settings, Host host = {});

    /// Undeformed and without speed, with the head here.
    void reset(const RootFrame& head_ws);
    /// Advances by dt seconds to this pose of the head; what it was before moves there evenly. A dt that is
    /// not above 0 changes nothing, others count as 10⁻⁶…1000 s; a head that is no position within 1e6 m
    /// stays where it was. `spheres_ws`: where they are at the end; those that are no numbers are left out.
    void step(const RootFrame& head_ws, float dt, std::span<const Sphere> spheres_ws = {});
    // Calls that are given arrays return false, and do nothing, where one has the wrong size.

    /// Where the hair is: metres, world, in the order given to make(), pointCount() of them.
    bool evaluate(std::span<Float3> positions_ws) const;

    std::uint32_t pointCount() const { return static_cast<std::uint32_t>(points_.size()); }
    std::uint32_t controlPointCount() const { return static_cast<std::uint32_t>(nodes_.size()); }
    /// Metres, world; x runs fastest, then y.
    bool readControlPoints(std::span<Float3> controlPoints_ws) const;
    /// Puts the control points there, without speed against the head. Those that are no numbers go to rest.
    bool setControlPoints(std::span<const Float3> controlPoints_ws);

    struct StepReport {
        std::uint64_t nodeUpdates = 0;  ///< control points times iterations over all substeps
    };
    const StepReport& lastStep() const { return report_; }
    /// Memory that a step works on. It depends on the hair where spheres are met.
    std::size_t stepBytes() const {
        const std::size_t met = pushes_.empty() ? 0 : points_.size() * sizeof(Point);
        return nodes_.size() * sizeof(Node) + pushes_.size() * sizeof(Float3) + met;
    }

  private:
    struct Node {
        Float3 rest_ss;       ///< metres
        float attachment;     ///< ω², 1/s²
        float scale;          ///< inverse diagonal of the step's matrix
        Float3 displacement;  ///< from the rigidly moved rest position, metres, world axes
        Float3 velocity;      ///< against the head, m/s
        Float3 headVelocity;  ///< of the rigidly moved rest position over the last substep, m/s
        Float3 change, residual, direction, image;  ///< of the conjugate gradients
        Float3 push;                                ///< of spheres, times `pushWeight`
        float pushWeight;
    };
    struct Point {
        Float3 rest_ss;  ///< metres
        Float3 cells;    ///< position in the lattice: control point i stands at i
        float radius;    ///< metres that it keeps from spheres; negative of a root, which they do not move
    };
    Lattice() = default;

    void layOut(const StrandsView& strands);
    void attach(const StrandsView& strands);
    void advance(const RootFrame& from, const RootFrame& to, bool teleported, float h);
    void solve(float damped, float h);
    /// Force per displacement at a control point: attachment and coupling.
    Float3 springs(std::size_t node, Float3 Node::*field) const;
    Float3 displacementAt(const Point& point) const;
    Float3 positionOf(const Point& point) const;
    Float3 outside(const Point& point, Float3 position_ws) const;
    void collide();

    LatticeSettings settings_;
    Host host_;
    RootFrame head_;
    std::vector<Node> nodes_;
    std::vector<Point> points_;
    std::vector<Sphere> spheres_;  ///< of the last step
    std::vector<Float3> pushes_;   ///< by point
    StepReport report_;
};

struct Lattice::Result {
    std::optional<Lattice> lattice;
    std::string error;  ///< empty when there is a lattice
};

}  // namespace hairloom::runtime
