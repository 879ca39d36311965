// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: motion of the head, frame times, changes in mid-run.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/accuracy/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::SimulationSettings;

constexpr float kTurnsPerSecond = 10.0f;
constexpr float kAlternating[] = {0.001f, 0.033f, 0.25f, 1.0f};

float spinAt(double time) {
    const double turns = kTurnsPerSecond * time;
    return 2.0f * std::numbers::pi_v<float> * static_cast<float>(turns - std::floor(turns));
}

}  // namespace

void turningHead(Trial& trial) {
    trial.start(tuft());
    for (int f = 1; f <= 250; ++f) {
        trial.moveRoots({}, turnAboutY(spinAt(f / 60.0)));
        trial.frame();
    }
    trial.settle();
}

void teleport(Trial& trial) {
    trial.start(tuft());
    trial.shakeRoots();
    trial.sourceEnds();  // a cut feeds nothing
    trial.moveRoots({10.0f, 0.0f, 0.0f}, turnAboutY(2.0f));
    trial.frame();
    trial.moveRoots({});
    trial.settle();
}

void frameTimes(Trial& trial) {
    trial.start(tuft(), {}, 1.0f);
    const auto run = [&](float dt, int count) {
        for (int f = 0; f < count; ++f) {
            const double t = trial.time() + static_cast<double>(dt);
            trial.moveRoots({0.02f * static_cast<float>(std::sin(3.0 * t)), 0.0f, 0.0f});
            trial.frame(dt);
        }
    };
    run(0.001f, 500);
    run(0.033f, 100);
    run(0.25f, 40);
    run(1.0f, 40);
    for (int round = 0; round < 20; ++round) {
        for (const float dt : kAlternating) run(dt, 1);
    }
    trial.settle();
}

void changesInMidRun(Trial& trial) {
    trial.start(tuft());
    const std::uint32_t own = trial.settings().substeps;
    const auto shake = [&](int frames) {
        for (int f = 0; f < frames; ++f) {
            const double t = trial.time() + static_cast<double>(kFrame);
            trial.moveRoots({0.03f * static_cast<float>(std::sin(12.0 * t)), 0.0f, 0.0f});
            trial.frame();
        }
    };
    for (const runtime::Integrator other : trial.options().integrators) {
        // Explicit Euler holds no undamped wave; it is a neighbour that others must recover from.
        SimulationSettings s = trial.settings();
        s.integrator = other;
        s.substeps = std::max(own, 16u);
        trial.change(s);
        shake(other == runtime::Integrator::explicitEuler ? 1 : 10);
        s.integrator = trial.integrator();
        s.substeps = std::min(own + 5, 64u);
        trial.change(s);
        shake(10);
        s.substeps = own;
        trial.change(s);
        shake(10);
    }
    for (const std::uint32_t points : {8u, 2u, 15u, 16u}) {
        trial.restart(tuft(points, 0.18f / static_cast<float>(points - 1)), SimulationSettings{});
        shake(20);
    }
    trial.settle();
}

void everythingAtOnce(Trial& trial) {
    SimulationSettings settings;
    settings.angularStiffness = stiffer(settings.angularStiffness, 1e6);
    settings.windKind = runtime::WindKind::uniform;
    settings.windSpeed = 100.0f;
    trial.start(tuft(), settings, 1.0f);
    SimulationSettings calm = trial.settings();
    calm.windSpeed = 0.0f;
    for (int f = 0; f < 250; ++f) {
        SimulationSettings s = trial.settings();
        s.windDirection.x = f % 2 == 0 ? 1.0f : -1.0f;
        trial.change(s);
        const float dt = kAlternating[f % 4];
        trial.moveRoots({}, turnAboutY(spinAt(trial.time() + static_cast<double>(dt))));
        trial.frame(dt);
    }
    trial.change(calm);
    trial.settle();
}

}  // namespace hairloom::hardcases
