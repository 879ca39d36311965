// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: motion of the head, frame times, changes in mid-run.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/stability/hard_cases.h"

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

void turningHead(HardCaseRun& caseRun) {
    caseRun.start(tuft());
    for (int f = 1; f <= 250; ++f) {
        caseRun.moveRoots({}, turnAboutY(spinAt(f / 60.0)));
        caseRun.frame();
    }
    caseRun.settle();
}

void teleport(HardCaseRun& caseRun) {
    caseRun.start(tuft());
    caseRun.shakeRoots();
    caseRun.sourceEnds();  // a cut feeds nothing
    caseRun.moveRoots({10.0f, 0.0f, 0.0f}, turnAboutY(2.0f));
    caseRun.frame();
    caseRun.moveRoots({});
    caseRun.settle();
}

void frameTimes(HardCaseRun& caseRun) {
    caseRun.start(tuft(), {}, 1.0f);
    const auto run = [&](float dt, int count) {
        for (int f = 0; f < count; ++f) {
            const double t = caseRun.time() + static_cast<double>(dt);
            caseRun.moveRoots({0.02f * static_cast<float>(std::sin(3.0 * t)), 0.0f, 0.0f});
            caseRun.frame(dt);
        }
    };
    run(0.001f, 500);
    run(0.033f, 100);
    run(0.25f, 40);
    run(1.0f, 40);
    for (int round = 0; round < 20; ++round) {
        for (const float dt : kAlternating) run(dt, 1);
    }
    caseRun.settle();
}

void changesInMidRun(HardCaseRun& caseRun) {
    caseRun.start(tuft());
    const std::uint32_t own = caseRun.settings().substeps;
    const auto shake = [&](int frames) {
        for (int f = 0; f < frames; ++f) {
            const double t = caseRun.time() + static_cast<double>(kFrame);
            caseRun.moveRoots({0.03f * static_cast<float>(std::sin(12.0 * t)), 0.0f, 0.0f});
            caseRun.frame();
        }
    };
    for (const runtime::Integrator other : caseRun.options().integrators) {
        // Explicit Euler holds no undamped wave; it is a neighbour that others must recover from.
        SimulationSettings s = caseRun.settings();
        s.strandModel = runtime::StrandModel::springs;
        s.integrator = other;
        s.substeps = std::max(own, 16u);
        caseRun.change(s);
        shake(other == runtime::Integrator::explicitEuler ? 1 : 10);
        s.strandModel = caseRun.method().model;
        s.integrator = caseRun.method().integrator;
        s.substeps = std::min(own + 5, 64u);
        caseRun.change(s);
        shake(10);
        s.substeps = own;
        caseRun.change(s);
        shake(10);
    }
    for (const std::uint32_t points : {8u, 2u, 15u, 16u}) {
        caseRun.restart(tuft(points, 0.18f / static_cast<float>(points - 1)), SimulationSettings{});
        shake(20);
    }
    caseRun.settle();
}

void everythingAtOnce(HardCaseRun& caseRun) {
    SimulationSettings settings;
    settings.angularStiffness = stiffer(settings.angularStiffness, 1e6);
    settings.windKind = runtime::WindKind::uniform;
    settings.windSpeed = 100.0f;
    caseRun.start(tuft(), settings, 1.0f);
    SimulationSettings calm = caseRun.settings();
    calm.windSpeed = 0.0f;
    for (int f = 0; f < 250; ++f) {
        SimulationSettings s = caseRun.settings();
        s.windDirection.x = f % 2 == 0 ? 1.0f : -1.0f;
        caseRun.change(s);
        const float dt = kAlternating[f % 4];
        caseRun.moveRoots({}, turnAboutY(spinAt(caseRun.time() + static_cast<double>(dt))));
        caseRun.frame(dt);
    }
    caseRun.change(calm);
    caseRun.settle();
}

void randomStorms(HardCaseRun& caseRun) {
    if (!caseRun.method().rods()) caseRun.disclaim("springs claim no storm, rods do");
    double fastest = 0.0, calm = 0.0;
    for (std::uint32_t storm = 0; storm < caseRun.options().storms && !caseRun.over(); ++storm) {
        const double left = runStorm(caseRun, storm);
        if (!(left <= fastest)) fastest = left;
        if (left <= 0.005) calm += 1.0;
    }
    caseRun.expectEnergy("speed five seconds after a storm", "m/s", fastest, 0.5);
    caseRun.expectEnergy("storms that end above 5 mm/s", "%",
                         100.0 * (1.0 - calm / std::max(caseRun.options().storms, 1u)), 5.0);
}

}  // namespace hairloom::hardcases
