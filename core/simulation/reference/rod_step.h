// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of an elastic rod, in maximal coordinates: positions x of the points, rotations Q of the segments,
// and multipliers λ of the constraints that tie them,
//   m_p ẍ_p = f_p − λ_{p−1} + λ_p,    x_{j+1} − x_j = l_j Q_j t_j,    g_j − g_{j+1} = l_j Q_j t_j × λ_j,
// with the moment g_j = Q_{j−1} (w + [v]×) K_j (e_j + τ ė_j) of a vertex, (w, v) = p_j (rod_shape.h).
// Rotations have no inertia: only x, its speed and e have rates, and those are of Radau IIA collocation.
// Constraints hold at all stages; speeds lose what would change a length at the end.

#include "core/simulation/reference/banded_matrix.h"
#include "core/simulation/reference/rod_shape.h"
#include "core/simulation/reference/root_path.h"

namespace hairloom::reference {

/// What a rod has beside the positions and speeds of its points.
struct RodMotion {
    std::vector<Quaterniond> rotation;  ///< Q_j
    std::vector<Vec3d> spin;            ///< rad/s in the last step, where the next one starts its search
    std::vector<Vec3d> tension;         ///< λ_j, likewise
};

/// Memory of the solve.
struct RodWorkspace {
    std::vector<ComplexBandedMatrix> matrices;
    std::vector<std::complex<double>> solution;
};

/// The authored shape on that root.
RodMotion rodAtRest(const RodShape& rod, const Quaterniond& root);
/// Turns each segment, in the least way, to where its points are.
void turnToPoints(const StrandShape& body, const RodShape& rod, const std::vector<Vec3d>& x,
                  RodMotion& motion);
/// For points of a mean mass of 1 kg, J.
double elasticEnergy(const StrandShape& body, const RodShape& rod, const Quaterniond& root,
                     const RodMotion& motion);

struct RodStepResult {
    bool converged;
    std::size_t contacts = 0;  ///< points that a sphere pushes, at the end
    double penetration = 0.0;  ///< deepest, at the end, m
};

/// Advances from one share of the frame to a later one. Spheres push what is inside: a spring of (10/h²) per
/// mass with a dashpot for restitution, and Coulomb friction in which what sticks creeps by at most
/// h · 0.5 m/s² per second; so that shorter steps of length h come to hard contacts and dry friction, with
/// order 1. Without convergence state and motion are of no use.
RodStepResult stepRod(const Physics& physics, const StrandShape& body, const RodShape& rod,
                      std::size_t stages, const RootPath& path, double from, double to, StrandState& state,
                      RodMotion& motion, RodWorkspace& work);

}  // namespace hairloom::reference
