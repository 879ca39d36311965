// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Forces of docs/engine.md on one strand, their energies, and the derivatives that an implicit step needs.

#include <vector>

#include "core/simulation/reference/strand.h"

namespace hairloom::reference {

/// Potential energies, for masses of mean 1.
struct Potentials {
    double gravity = 0;  ///< 0 at the origin of the world
    double springs = 0;  ///< coil and flexion springs
    double angular = 0;
};

/// F_j of each segment: carried from the root by shortest arcs.
std::vector<Quaterniond> carriedFrames(const StrandShape& shape, const std::vector<Vec3d>& x,
                                       const Quaterniond& rotation);

/// Velocity of the air, m/s.
Vec3d airVelocity(const Physics& physics, const Vec3d& position, double time);

/// Force on each point (that on clamped points is of no use), divided by the unit of mass: m/s².
void addForces(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
               const std::vector<Vec3d>& v, const Environment& around, std::vector<Vec3d>& force);

Potentials potentials(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                      const Quaterniond& rotation);

/// Takes −∂force_p/∂x_q · position − ∂force_p/∂v_q · speed, a block for each pair of free points within two
/// of each other.
class BlockSink {
  public:
    virtual ~BlockSink() = default;
    virtual void add(std::size_t p, std::size_t q, const Eigen::Matrix3d& block) = 0;
};

/// Exact for coil, flexion and penalty springs and for damping. The frames and the sine of the air's angle
/// count as constant, and angular springs as those of the small-angle method: a Newton iteration with these
/// converges linearly, to the same solution.
void addDerivatives(const Physics& physics, const StrandShape& shape, const std::vector<Vec3d>& x,
                    const std::vector<Vec3d>& v, const Environment& around, double position, double speed,
                    BlockSink& sink);

}  // namespace hairloom::reference
