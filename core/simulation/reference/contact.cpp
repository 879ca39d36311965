// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/contact.h"

#include <algorithm>

#include "core/simulation/reference/lengths.h"

namespace hairloom::reference {
namespace {

constexpr int kMaxSweeps = 1000;
constexpr double kSmallSpeed = 1e-11;     // m/s
constexpr double kSmallDistance = 1e-12;  // m
/// Points change by at most so many times the fastest approach and the deepest penetration. What would need
/// more has no sound solution: a straight strand pressed end-on would have to buckle at once, one between two
/// spheres has nowhere to go.
constexpr double kMaxGain = 8.0;

struct Contact {
    std::size_t point;
    Vec3d normal;
    Vec3d sphereVelocity;
    double bounce;                 ///< speed at which it leaves, m/s
    double pressed = 0.0;          ///< impulse along the normal so far
    Vec3d rubbed = Vec3d::Zero();  ///< impulse of friction so far
};

Vec3d normalAt(const Vec3d& x, const SphereNow& sphere) {
    const Vec3d offset = x - sphere.center;
    const double distance = offset.norm();
    return distance > 0.0 ? Vec3d(offset / distance) : Vec3d(Vec3d::UnitY());
}

std::vector<Contact> findContacts(const Physics& physics, const StrandShape& shape,
                                  std::span<const ColliderNow> colliders, const StrandState& state) {
    std::vector<Contact> contacts;
    for (const ColliderNow& collider : colliders) {
        for (std::size_t p = shape.firstFree; p < shape.points(); ++p) {
            const SphereNow sphere = collider.at(state.x[p]);
            if ((state.x[p] - sphere.center).norm() >= reach(physics, shape, p, sphere.radius)) continue;
            Contact contact{p, normalAt(state.x[p], sphere), sphere.velocity, 0.0};
            const double speed = contact.normal.dot(state.v[p] - sphere.velocity);
            contact.bounce = physics.restitution * std::max(0.0, -speed);
            contacts.push_back(contact);
        }
    }
    return contacts;
}

/// One step of Gauss-Seidel with impulses summed up, so that each stays within its cone (after Catto 2005).
void press(const Physics& physics, double mass, Contact& contact, Vec3d& v) {
    const Vec3d relative = v - contact.sphereVelocity;
    const double speed = contact.normal.dot(relative);
    const double pressed = std::max(0.0, contact.pressed + mass * (contact.bounce - speed));
    v += contact.normal * ((pressed - contact.pressed) / mass);
    contact.pressed = pressed;

    Vec3d rubbed = contact.rubbed - mass * (relative - contact.normal * speed);
    const double size = rubbed.norm(), maximum = physics.friction * pressed;
    if (size > maximum) rubbed *= maximum / size;
    v += (rubbed - contact.rubbed) / mass;
    contact.rubbed = rubbed;
}

double largestChange(const std::vector<Vec3d>& from, const std::vector<Vec3d>& to) {
    double largest = 0.0;
    for (std::size_t p = 0; p < from.size(); ++p)
        largest = std::max(largest, (to[p] - from[p]).cwiseAbs().maxCoeff());
    return largest;
}

double fastestApproach(const std::vector<Contact>& contacts, const std::vector<Vec3d>& v) {
    double fastest = 0.0;
    for (const Contact& contact : contacts)
        fastest = std::max(fastest, -contact.normal.dot(v[contact.point] - contact.sphereVelocity));
    return fastest;
}

/// False where the strand cannot take the blow.
bool solveVelocities(const Physics& physics, const StrandShape& shape, std::vector<Contact>& contacts,
                     StrandState& state) {
    const std::vector<Vec3d> start = state.v;
    const double maximum = kMaxGain * fastestApproach(contacts, start);
    std::vector<Vec3d> before;
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        before = state.v;
        for (Contact& contact : contacts)
            press(physics, shape.masses[contact.point], contact, state.v[contact.point]);
        if (physics.lengthHeld) projectVelocities(shape, state.x, state.v);
        if (!(largestChange(start, state.v) <= maximum)) return false;
        if (largestChange(before, state.v) < kSmallSpeed) break;
    }
    return true;
}

/// Deepest penetration, before the points that are inside go to the surface.
double pushOut(const Physics& physics, const StrandShape& shape, std::span<const ColliderNow> colliders,
               std::vector<Vec3d>& x, bool move) {
    double deepest = 0.0;
    for (const ColliderNow& collider : colliders) {
        for (std::size_t p = shape.firstFree; p < shape.points(); ++p) {
            const SphereNow sphere = collider.at(x[p]);
            const double keep = reach(physics, shape, p, sphere.radius);
            const double depth = keep - (x[p] - sphere.center).norm();
            deepest = std::max(deepest, depth);
            if (move && depth > 0.0) x[p] = sphere.center + normalAt(x[p], sphere) * keep;
        }
    }
    return deepest;
}

/// Moves the points from `moved` to the surfaces, with their lengths. Where that would take them too far they
/// stay at `x`, which has its lengths.
void resolvePositions(const Physics& physics, const StrandShape& shape,
                      std::span<const ColliderNow> colliders, const std::vector<Vec3d>& moved,
                      std::vector<Vec3d>& x) {
    std::vector<Vec3d> next = moved;
    const double maximum =
        kMaxGain * std::max(pushOut(physics, shape, colliders, x, false), largestChange(x, moved));
    for (int pass = 0; pass < kMaxSweeps; ++pass) {
        const double deepest = pushOut(physics, shape, colliders, next, true);
        if (physics.lengthHeld && !projectLengths(shape, next)) return;
        if (!(largestChange(x, next) <= maximum)) return;
        if (deepest < kSmallDistance) break;
    }
    x = std::move(next);
}

}  // namespace

ContactReport resolveContacts(const Physics& physics, const StrandShape& shape, double h,
                              std::span<const ColliderNow> colliders, StrandState& state) {
    ContactReport report;
    std::vector<Contact> contacts = findContacts(physics, shape, colliders, state);
    report.points = contacts.size();
    if (contacts.empty()) return report;

    const std::vector<Vec3d> before = state.v;
    if (!solveVelocities(physics, shape, contacts, state)) {
        // It stops, without bounce: no energy comes from what cannot be resolved.
        std::fill(state.v.begin() + static_cast<std::ptrdiff_t>(shape.firstFree), state.v.end(),
                  state.v[shape.firstFree - 1]);
        if (physics.lengthHeld) projectVelocities(shape, state.x, state.v);
    }
    std::vector<Vec3d> moved = state.x;
    for (std::size_t p = shape.firstFree; p < shape.points(); ++p)
        moved[p] += 0.5 * h * (state.v[p] - before[p]);
    resolvePositions(physics, shape, colliders, moved, state.x);
    if (physics.lengthHeld) projectVelocities(shape, state.x, state.v);
    report.penetration = pushOut(physics, shape, colliders, state.x, false);
    report.approach = fastestApproach(contacts, state.v);
    return report;
}

}  // namespace hairloom::reference
