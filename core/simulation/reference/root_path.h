// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The way of a strand's root, and of the spheres, through a frame.

#include <vector>

#include "core/simulation/reference/substep.h"

namespace hairloom::reference {

/// Shares of the frame run from 0 to 1. Places go evenly, rotations along the chord between their
/// quaternions.
struct RootPath {
    Vec3d from, to;
    Quaterniond turnFrom, turnTo;  // in the same half
    double dt, endTime;
    std::vector<ColliderNow> collidersAtEnd;

    Vec3d velocity() const { return (to - from) / dt; }
    Vec3d position(double share) const { return from + (to - from) * share; }
    Quaterniond rotation(double share) const { return Quaterniond(mixed(share).normalized()); }
    double time(double share) const { return endTime - (1.0 - share) * dt; }
    /// ω = 2 q̇ q*.
    Vec3d angularVelocity(double share) const {
        const Eigen::Vector4d u = mixed(share), q = u.normalized();
        const Eigen::Vector4d straight = (turnTo.coeffs() - turnFrom.coeffs()) / (dt * u.norm());
        const Quaterniond rate(Eigen::Vector4d(straight - q * q.dot(straight)));
        return 2.0 * (rate * Quaterniond(q).conjugate()).vec();
    }
    std::vector<ColliderNow> colliders(double share) const {
        std::vector<ColliderNow> now = collidersAtEnd;
        const double left = (1.0 - share) * dt;
        for (ColliderNow& collider : now) {
            collider.sphere.center -= collider.sphere.velocity * left;
            if (collider.other) collider.other->center -= collider.other->velocity * left;
        }
        return now;
    }
    ClampedEnd clamped(const StrandShape& shape, double share) const {
        ClampedEnd end;
        Vec3d offset = Vec3d::Zero();
        for (std::size_t p = 0; p < shape.firstFree; ++p) {
            if (p > 0) offset += rotation(share) * shape.edges[p - 1];
            end.x.push_back(position(share) + offset);
            end.v.push_back(velocity() + angularVelocity(share).cross(offset));
        }
        return end;
    }

  private:
    Eigen::Vector4d mixed(double share) const {
        return (1.0 - share) * turnFrom.coeffs() + share * turnTo.coeffs();
    }
};

}  // namespace hairloom::reference
