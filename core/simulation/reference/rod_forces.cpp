// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/rod_forces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulation/reference/forces.h"

namespace hairloom::reference {
namespace {

constexpr double kContactStiffness = 10.0;  // of a contact, over m/h²
constexpr double kCreep = 0.5;              // m/s², speed of what sticks over h

/// Damping over critical damping of a spring that returns that share of the speed.
double dampingRatio(double restitution) {
    if (!(restitution > 1e-3)) return 1.0;
    const double decay = -std::log(std::min(restitution, 1.0));
    return decay / std::hypot(std::numbers::pi, decay);
}

void addContact(const Physics& physics, const StrandShape& body, std::size_t p, const Vec3d& x,
                const Vec3d& v, const SphereNow& sphere, double h, PointForce& result) {
    const Vec3d offset = x - sphere.center;
    const double distance = offset.norm();
    const Vec3d normal = distance > 0.0 ? Vec3d(offset / distance) : Vec3d(Vec3d::UnitY());
    const double depth = reach(physics, body, p, sphere.radius) - distance;
    const double stiffness = body.masses[p] * kContactStiffness / (h * h);
    // Seconds of approach that a dashpot adds to the depth.
    const double ahead = 2.0 * dampingRatio(physics.restitution) * h / std::sqrt(kContactStiffness);
    const Vec3d relative = v - sphere.velocity;
    const double pressed = stiffness * (depth - ahead * normal.dot(relative));
    if (!(pressed > 0.0)) return;
    result.touches = true;
    result.penetration = std::max(result.penetration, depth);
    const Vec3d slip = across(normal, relative);
    const double size = std::hypot(slip.norm(), kCreep * h);
    const Vec3d push = normal - physics.friction * slip / size;
    result.force += pressed * push;
    const Eigen::Matrix3d slope = stiffness * push * normal.transpose();
    result.place += slope;
    result.speed += ahead * slope + (physics.friction * pressed / size) *
                                        (Eigen::Matrix3d::Identity() - normal * normal.transpose());
}

}  // namespace

PointForce pointForce(const Physics& physics, const StrandShape& body, std::size_t p, const Vec3d& x,
                      const Vec3d& v, const Vec3d& tangent, const Environment& around, double h) {
    PointForce result;
    const double mass = body.masses[p];
    result.force = mass * (physics.gravity - physics.dampingRate * (v - around.rootVelocity));
    double rate = physics.dampingRate;
    if (physics.airDrag > 0.0) {
        const Vec3d lacking = airVelocity(physics, x, around.time) - v;
        const double size = lacking.norm();
        const double drag =
            size > 0.0 ? physics.airDrag * std::min(1.0, lacking.cross(tangent).norm() / size) : 0.0;
        result.force += mass * drag * lacking;
        rate += drag;
    }
    result.speed = mass * rate * Eigen::Matrix3d::Identity();
    for (const ColliderNow& collider : around.colliders)
        addContact(physics, body, p, x, v, collider.at(x), h, result);
    return result;
}

Quaterniond relativeRotation(const Quaterniond& inner, const Quaterniond& outer, const Quaterniond& side) {
    Quaterniond p = inner.conjugate() * outer;
    if (p.dot(side) < 0.0) p.coeffs() *= -1.0;
    return p;
}

VertexMoment::VertexMoment(const Eigen::Matrix3d& elasticity, double dampingTime,
                           const Quaterniond& innerRotation, const Quaterniond& p, const Vec3d& rate) {
    // A small turn r of the outer segment, in the inner one's frame: dv = ½ (w − [v]×) r, dw = −½ v·r.
    const Vec3d v = p.vec();
    const Eigen::Matrix3d R = innerRotation.toRotationMatrix();
    const Eigen::Matrix3d change = p.w() * Eigen::Matrix3d::Identity() - crossMatrix(v);
    const Vec3d m = elasticity * (2.0 * v + dampingTime * rate);
    world = R * Vec3d(change.transpose() * m);
    const Eigen::Matrix3d straight = change.transpose() * elasticity * change;
    const Eigen::Matrix3d turning = -0.5 * (m * v.transpose() + crossMatrix(m) * change);
    elastic = R * (straight + turning) * R.transpose();
    viscous = R * (dampingTime * straight) * R.transpose();
}

}  // namespace hairloom::reference
