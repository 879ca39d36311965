// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Small scenes for the engine's tests.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/stability/strand_set.h"
#include "hairloom/engine.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {

inline void PrintTo(Integrator integrator, std::ostream* out) {
    *out << nameOf(integrator);
}

inline Quat turnAbout(Float3 axis, float angle) {
    const Float3 v = axis * std::sin(angle / 2.0f);
    return {v.x, v.y, v.z, std::cos(angle / 2.0f)};
}

using Strands = StrandSet;

/// Nothing acts but inertia and the length constraint.
inline SimulationSettings bare() {
    SimulationSettings s = springSettings();
    s.gravity = {};
    s.airDrag = 0.0f;
    s.angularStiffness = 0.0f;
    s.dampingTime = 0.0f;
    s.sleepSpeed = 0.0f;
    s.clampedPoints = 1;
    return s;
}

inline Engine makeEngine(const Strands& strands, const SimulationSettings& settings, Host host = {}) {
    Engine::Result made = Engine::make(strands.view(), settings, std::move(host));
    EXPECT_EQ(made.error, "");
    return std::move(*made.engine);
}

inline void run(Engine& engine, const Strands& strands, int frames, float dt = 1.0f / 60.0f,
                std::span<const Sphere> spheres = {}) {
    const std::vector<RootFrame> roots = strands.roots();
    for (int f = 0; f < frames; ++f) engine.step({dt, static_cast<double>(dt) * (f + 1), roots, spheres});
}

inline std::vector<Float3> positionsOf(const Engine& engine) {
    std::vector<Float3> positions(engine.pointCount());
    engine.readPositions(positions);
    return positions;
}

/// Strands of mixed point counts whose roots stand on a small plate.
inline Strands tuft(std::uint32_t count, bool mixed = false) {
    Strands strands;
    for (std::uint32_t s = 0; s < count; ++s) {
        const float f = static_cast<float>(s);
        strands.add({0.004f * f, 0.1f, 0.003f * std::sin(f)}, hangingAt(1.2f * std::sin(f * 1.7f) + 1.4f),
                    0.011f, mixed ? 2 + (s * 5) % 17 : 12);
    }
    return strands;
}

}  // namespace hairloom::runtime
