// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What acts on a free point of a rod from outside, and on a vertex from its own bending.

#include "core/simulation/reference/rod_shape.h"

namespace hairloom::reference {

/// Force on a point, N for a mean mass of 1 kg, and −∂force/∂x, −∂force/∂v; the sine of the air's angle and
/// the directions of contacts count as constant in these.
struct PointForce {
    Vec3d force = Vec3d::Zero();
    Eigen::Matrix3d place = Eigen::Matrix3d::Zero(), speed = Eigen::Matrix3d::Zero();
    bool touches = false;
    double penetration = 0.0;  ///< m
};

/// `tangent` is that of the segment before point p; `h` the step that contacts are as stiff for.
PointForce pointForce(const Physics& physics, const StrandShape& body, std::size_t p, const Vec3d& x,
                      const Vec3d& v, const Vec3d& tangent, const Environment& around, double h);

/// p of a vertex, on the side of another quaternion.
Quaterniond relativeRotation(const Quaterniond& inner, const Quaterniond& outer, const Quaterniond& side);

/// A vertex with the strain 2 vec(p) and its rate.
struct VertexMoment {
    VertexMoment(const Eigen::Matrix3d& elasticity, double dampingTime, const Quaterniond& innerRotation,
                 const Quaterniond& p, const Vec3d& rate);

    Vec3d world;  ///< g: on the outer segment, and its negative on the inner one
    /// ∂g/∂(turn of the outer less turn of the inner segment), apart from the turn of the whole, where the
    /// rate of a strain is `pace` times its change: `elastic` + `viscous` pace.
    Eigen::Matrix3d elastic, viscous;
};

}  // namespace hairloom::reference
