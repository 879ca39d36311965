// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A strand as an elastic rod: what `StrandModel::rods` adds to a strand's lengths and masses.

#include <vector>

#include "core/simulation/reference/strand.h"

namespace hairloom::reference {

/// Vertex j lies at the inner end of segment j. Its strain is e = 2 vec(p) of the rotation p = Q_{j−1}* Q_j
/// between its segments (Q_{first−1} is the root's), where Q takes a segment from the unloaded shape in the
/// root's frame to the world; its energy is ½ k (|e|² + (c − 1)(a·e)² + (f − 1)(n·e)²), c = GJ/EI₁, f =
/// EI₂/EI₁ of a section whose long diameter is n.
struct RodShape {
    std::vector<Vec3d> tangent;     ///< of segments, unloaded, in the root's frame
    std::vector<Vec3d> axis;        ///< a_j, unit
    std::vector<Vec3d> normal;      ///< n_j, unit, across a_j
    std::vector<double> stiffness;  ///< k_j = B/l̄ for points of a mean mass of 1, m²/s²; 0 beside the clamp
    double torsionRatio = 1.0;      ///< c
    double flatRatio = 1.0;         ///< f
    double dampingTime = 0.0;       ///< s, of the strain (Kelvin-Voigt)
    std::vector<Quaterniond> atRest;  ///< Q in the authored shape

    Eigen::Matrix3d elasticity(std::size_t j) const {
        return stiffness[j] *
               (Eigen::Matrix3d::Identity() + (torsionRatio - 1.0) * axis[j] * axis[j].transpose() +
                (flatRatio - 1.0) * normal[j] * normal[j].transpose());
    }
};

/// `gravityAtRest` is gravity turned into the root's frame of the rest pose. The unloaded shape is the one
/// that hangs in the authored shape under `restGravity` of its weight. Where that weight would bend it too
/// far, or could let it swing round or buckle, the vertices that it bends most are stiffer than the settings
/// say: it stands for the hair around.
RodShape makeRodShape(const StrandShape& body, const runtime::SimulationSettings& settings,
                      const Vec3d& gravityAtRest);

/// [v]× of v × w.
Eigen::Matrix3d crossMatrix(const Vec3d& v);
/// Rotation by |u| about u.
Quaterniond turnBy(const Vec3d& u);
/// The u of the shorter turn.
Vec3d turnOf(const Quaterniond& q);

}  // namespace hairloom::reference
