// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands and settings for the tests of the reference.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/simulation/reference/solver.h"
#include "tests/support/spring_settings.h"

namespace hairloom::test {

inline constexpr double kGravity = static_cast<double>(9.81f);
inline constexpr double kTau = 2.0 * std::numbers::pi;

/// One strand along a direction.
inline reference::Strands straightStrand(std::size_t segments, double length,
                                         const Vec3d& direction = Vec3d::UnitX()) {
    reference::Strands strands;
    strands.offsets = {0, static_cast<std::uint32_t>(segments + 1)};
    for (std::size_t p = 0; p <= segments; ++p)
        strands.restPositions_ss.push_back(direction *
                                           (length * static_cast<double>(p) / static_cast<double>(segments)));
    return strands;
}

/// Nothing acts: no damping, no bending, no air; gravity as it is, inextensible, hinged at the root.
inline runtime::SimulationSettings bareSettings() {
    runtime::SimulationSettings s = runtime::springSettings();
    s.dampingTime = 0.0f;
    s.bendDampingTime = 0.0f;
    s.clampedPoints = 1;
    s.angularStiffness = 0.0f;
    s.angularCurve = {};
    s.restGravity = 0.0f;
    s.airDrag = 0.0f;
    s.windSpeed = 0.0f;
    s.collisionRadiusRoot = s.collisionRadiusTip = 0.0f;
    s.friction = 0.0f;
    s.restitution = 0.0f;
    return s;
}

/// A curl around the x axis.
inline reference::Strands helixStrand(std::size_t segments, double length, double radius, double turns) {
    reference::Strands strands = straightStrand(segments, length);
    for (Vec3d& x : strands.restPositions_ss) {
        const double angle = kTau * turns * x.x() / length;
        x += radius * Vec3d(0.0, 1.0 - std::cos(angle), std::sin(angle));
    }
    return strands;
}

inline reference::Solver solverOf(
    const reference::Strands& strands, const runtime::SimulationSettings& s,
    reference::BendingForce bendingForce = reference::BendingForce::framesHeld) {
    Result<reference::Solver> made = reference::Solver::make(strands, s, bendingForce);
    if (!made) ADD_FAILURE() << made.error().message();
    return std::move(made).value();
}

/// The root stays at the origin.
inline reference::Frame stillFrame(double dt, double time = 0.0) {
    return {dt, time, {reference::Root{}}, {}};
}

inline double agm(double a, double b) {
    for (int i = 0; i < 40; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return a;
}

}  // namespace hairloom::test
