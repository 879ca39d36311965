// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: how rods come to rest on spheres, and rods without stiffness.
#include <cmath>

#include "core/stability/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::Float3;
using runtime::SimulationSettings;

constexpr double kToRest = 15.0;  // seconds

void claimedByRods(HardCaseRun& caseRun) {
    if (!caseRun.method().rods()) caseRun.disclaim("springs claim no rest in contact; rods do");
}

SimulationSettings awake() {
    SimulationSettings settings;
    settings.sleepSpeed = 0.0f;
    return settings;
}

/// Hair that stands out level, 24 points over 29 cm.
StrandSet level() {
    StrandSet strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.0125f, 24);
    return strands;
}

StrandSet curls() {
    StrandSet strands;
    for (int s = 0; s < 4; ++s) {
        std::vector<Float3> curl;
        for (int p = 0; p < 48; ++p) {
            const float turn = 0.5f * static_cast<float>(p);
            curl.push_back({0.008f * (std::cos(turn) - 1.0f) + 0.01f * static_cast<float>(s),
                            0.1f - 0.004f * static_cast<float>(p), 0.008f * std::sin(turn)});
        }
        strands.add(curl);
    }
    return strands;
}

}  // namespace

void noStiffness(HardCaseRun& caseRun) {
    claimedByRods(caseRun);
    for (const float stiffness : {0.0f, 1e-9f, 0.3f}) {
        for (const bool atRoot : {false, true}) {
            for (const bool curled : {false, true}) {
                SimulationSettings settings;
                settings.angularStiffness = stiffness;
                settings.angularCurve =
                    atRoot ? runtime::Ramp::straight(0.0f, 1.0f) : runtime::Ramp::straight(1.0f, 0.0f);
                settings.restGravity = atRoot ? 1.0f : 0.0f;
                caseRun.restart(curled ? curls() : tuft(), settings);
                caseRun.shakeRoots();
                caseRun.frames(60);
                caseRun.setSpheres({{{0.0f, 0.02f, 0.0f}, 0.04f}});
                caseRun.frames(240);
                caseRun.expect("speed", "m/s", caseRun.greatestSpeed(), 0.005);
                caseRun.setSpheres({});
            }
        }
    }
}

void viceOfSpheres(HardCaseRun& caseRun) {
    claimedByRods(caseRun);
    caseRun.start(tuft(), awake());
    for (int f = 1; f <= 60; ++f) {
        const float away = 0.05f + 0.05f * (1.0f - static_cast<float>(f) / 60.0f);
        caseRun.setSpheres({{{away, 0.0f, 0.0f}, 0.05f}, {{-away, 0.0f, 0.0f}, 0.05f}});
        caseRun.frame();
    }
    caseRun.settle(kToRest);
}

void bouncingStrand(HardCaseRun& caseRun) {
    claimedByRods(caseRun);
    for (const float restitution : {0.2f, 0.5f, 1.0f}) {
        SimulationSettings settings = awake();
        settings.restitution = restitution;
        settings.restGravity = 0.0f;
        caseRun.restart(level(), settings);
        caseRun.setSpheres({{{0.12f, -0.07f, 0.0f}, 0.05f}});
        caseRun.frames(static_cast<int>(kToRest / static_cast<double>(kFrame)));
        caseRun.expect("speed", "m/s", caseRun.greatestSpeed(), 0.005);
    }
}

void sphereOfAKilometre(HardCaseRun& caseRun) {
    claimedByRods(caseRun);
    SimulationSettings settings = awake();
    settings.restGravity = 0.0f;
    caseRun.start(level(), settings);
    caseRun.setSpheres({{{0.1f, -1000.05f, 0.0f}, 1000.0f}});
    caseRun.watchSpheres();
    caseRun.frames(120);
    caseRun.settle(kToRest);
}

}  // namespace hairloom::hardcases
