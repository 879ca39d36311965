// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rods for the tests of the reference.

#include <algorithm>

#include "tests/simulation/reference_fixture.h"

namespace hairloom::test {

/// As bareSettings(), an elastic rod with a clamped segment.
inline runtime::SimulationSettings bareRods() {
    runtime::SimulationSettings s = bareSettings();
    s.strandModel = runtime::StrandModel::rods;
    s.clampedPoints = 2;
    return s;
}

/// Lets strands come to rest on roots that stay at the origin; the speed that is left, m/s. Frames grow
/// longer while that goes well: the implicit Euler method then is Newton's on the energy.
inline double comeToRest(reference::Solver& solver) {
    double dt = 1.0 / 60.0, speed = 1.0;
    for (int frame = 0; frame < 400 && speed > 1e-11; ++frame) {
        const reference::StepReport report = solver.step(stillFrame(dt), {1, 1});
        EXPECT_EQ(report.failed, 0u) << "frame " << frame;
        speed = 0.0;
        for (const Vec3d& v : solver.velocities_ws()) speed = std::max(speed, v.norm());
        dt = report.halved > 0 ? 0.5 * dt : std::min(2.0, 1.2 * dt);
    }
    return speed;
}

}  // namespace hairloom::test
