// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {

/// Free points of strands without a length constraint: each hangs 1 cm beside its root.
struct FreePoints {
    Strands strands;
    SimulationSettings settings = bare();

    FreePoints() {
        settings.lengthIterations = 0;
        settings.substeps = 1;
        settings.collisionRadiusTip = 0.0f;
        settings.friction = 0.0f;
        settings.teleportDistance = 100.0f;
    }
    void add(Float3 at) { strands.add(at - Float3{0.01f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.01f, 2); }
    Engine engine() const { return makeEngine(strands, settings); }
    static Float3 position(const Engine& engine, std::size_t point = 0) {
        return positionsOf(engine)[2 * point + 1];
    }
    static Float3 velocity(const Engine& engine) {
        std::vector<Float3> v(engine.pointCount());
        engine.readVelocities(v);
        return v[1];
    }
    /// Steps until the points move by `displacement` in each step of dt, then takes gravity away.
    void accelerate(Engine& engine, Float3 displacement, float dt) {
        constexpr int kSteps = 60;
        // From rest the first step gives half of a h².
        settings.gravity = displacement * (1.0f / ((kSteps - 0.5f) * dt * dt));
        EXPECT_EQ(engine.setSettings(settings), "");
        run(engine, strands, kSteps, dt);
        settings.gravity = {};
        EXPECT_EQ(engine.setSettings(settings), "");
    }
};

}  // namespace hairloom::runtime
