// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One strand of the reference: what it is made of, how it moves now, and the physics that acts on it, all in
// double precision. Symbols are those of docs/engine.md.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "hairloom/settings.h"
#include "hairloom/wind.h"

namespace hairloom::reference {

using Eigen::Quaterniond;

/// What force angular springs exert, of the same energy.
enum class BendingForce {
    framesHeld,  ///< its gradient with the frames F held. Curled strands gain energy from nothing.
    gradient     ///< its whole gradient, with how each segment turns the frames after it: conserves energy
};

/// The settings as the model reads them.
struct Physics {
    explicit Physics(const runtime::SimulationSettings& settings,
                     BendingForce bendingForce = BendingForce::framesHeld);
    /// Both values of `input` are finite.
    void takeWind(const runtime::SimulationSettings& settings, const runtime::WindInput& input);

    bool rods;               ///< StrandModel::rods; then no springs act
    Vec3d gravity;           ///< m/s²
    double airDrag;          ///< 1/s
    double dampingRate;      ///< 1/dampingTime, 0 for none
    double bendDampingTime;  ///< s
    bool lengthHeld;         ///< segments are inextensible
    bool coilSprings;        ///< segments are coil springs
    bool angularSprings;     ///< small-angle or exact
    bool framesTurn;         ///< BendingForce::gradient
    bool exactDirection;     ///< exact
    bool flexionSprings;
    bool penalty;                                        ///< spheres push by a spring instead of an impulse
    double penaltyStiffness;                             ///< (2π penaltyFrequency)², 1/s²
    double collisionRadiusAtRoot, collisionRadiusAtTip;  ///< m
    double friction;
    double restitution;
    std::size_t clampedPoints;
    double teleportDistance;  ///< m
    bool windy;
    runtime::Wind wind;
};

/// Rest shape and what follows from it and the settings. n segments, n + 1 points.
struct StrandShape {
    std::vector<Vec3d> edges;        ///< v*_j, in the frame of the root, m
    std::vector<double> lengths;     ///< l_j, above 0
    std::vector<double> masses;      ///< m_p, of mean 1
    std::vector<double> stiffness;   ///< κ_j of joint j = 0 … n−1; 0 where there is none
    std::vector<Vec3d> bend;         ///< c_j less H_j/κ_j (c_0 = d_0), in the frame of the root
    std::vector<double> coil;        ///< k_j of segment j = 0 … n−1; used when coilSprings is on
    std::vector<double> flexion;     ///< of the pair p_{j−1}, p_{j+1}, j = 1 … n−1 (entry 0 unused)
    std::vector<double> pairLength;  ///< rest distance of that pair
    std::size_t firstFree;           ///< points before it follow the root
    double stiffer = 1.0;            ///< times the stiffness that settings say

    std::size_t points() const { return masses.size(); }
    std::size_t segments() const { return lengths.size(); }
};

/// Lengths and masses alone, without springs. `edges` in the root's frame, each of a length above 0;
/// `authoredMasses` empty or one above 0 per point; `stiffer` as StrandsView::stiffness.
StrandShape makeBody(std::vector<Vec3d> edges, std::span<const double> authoredMasses,
                     const runtime::SimulationSettings& settings, double stiffer = 1.0);
/// With the springs of StrandModel::springs.
StrandShape makeShape(std::vector<Vec3d> edges, std::span<const double> authoredMasses,
                      const runtime::SimulationSettings& settings, double stiffer = 1.0);

/// The part of v across the unit vector t.
inline Vec3d across(const Vec3d& t, const Vec3d& v) {
    return v - t * t.dot(v);
}

/// angularStiffness at that share of the segments.
double authoredStiffness(const runtime::SimulationSettings& settings, double along);
/// B of an authored stiffness 0 ≤ s < 1, m⁴/s².
double bendingStiffness(double authored);

struct StrandState {
    std::vector<Vec3d> x;  ///< m, world
    std::vector<Vec3d> v;  ///< m/s, world
};

struct SphereNow {
    Vec3d center;
    Vec3d velocity;
    double radius;
};

/// A sphere, or the hull of two.
struct ColliderNow {
    SphereNow sphere;
    std::optional<SphereNow> other = {};

    /// The sphere of the hull that meets x: of all those between the two the one whose surface is lowest
    /// there.
    SphereNow at(const Vec3d& x) const;
};

/// The world at one moment.
struct Environment {
    double time;           ///< s, of the wind
    Quaterniond rotation;  ///< R, of the root less its rest rotation
    Vec3d rootVelocity;    ///< m/s
    std::span<const ColliderNow> colliders;
};

/// Distance that point p keeps from the centre of a sphere of that radius.
double reach(const Physics& physics, const StrandShape& shape, std::size_t p, double radius);

}  // namespace hairloom::reference
