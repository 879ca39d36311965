// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: stiffness, storms, energy, rest and input that is no number.
#include <cmath>
#include <limits>

#include "core/accuracy/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::Float3;
using runtime::SimulationSettings;

constexpr std::uint32_t kPoints = 16;
constexpr float kSegment = 0.012f;  // metres

/// Joules in the angular springs of straight, even strands with two clamped points (docs/engine.md,
/// "Stiffness").
double bendingEnergy(const StrandSet& strands, const SimulationSettings& settings,
                     const std::vector<Float3>& positions) {
    const double l = static_cast<double>(kSegment);
    constexpr double kMass = static_cast<double>(kPoints) / (kPoints - 1);  // of an inner point
    double energy = 0.0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        const std::uint32_t first = strands.offsets[s];
        for (std::uint32_t j = 1; j + 1 < kPoints; ++j) {
            const double share = static_cast<double>(j) / (kPoints - 1);
            const double setting =
                static_cast<double>(settings.angularStiffness) * settings.angularCurve.at(share);
            const double kappa = runtime::kHairBendingStiffness * setting / (1.0 - setting) * kMass / l /
                                 (j == 1 ? 0.5 * l : l);
            const Float3* p = positions.data() + first + j;
            const double bend = static_cast<double>(length(p[1] - p[0] * 2.0f + p[-1])) / l;
            energy += 0.5 * kappa * bend * bend;
        }
    }
    return energy;
}

}  // namespace

float stiffer(float setting, double factor) {
    const double s = static_cast<double>(setting), ratio = factor * s / (1.0 - s);
    return static_cast<float>(ratio / (1.0 + ratio));
}

void stiffnessTimesMillion(Trial& trial) {
    SimulationSettings settings;
    settings.angularStiffness = stiffer(settings.angularStiffness, 1e6);
    trial.start(tuft(), settings);
    trial.shakeRoots();
    trial.frames(190);
    trial.settle();
}

void reversingStorm(Trial& trial) {
    SimulationSettings settings;
    settings.windKind = runtime::WindKind::uniform;
    settings.windSpeed = 100.0f;
    trial.start(tuft(), settings);
    SimulationSettings s = trial.settings();
    for (int f = 0; f < 250; ++f) {
        s.windDirection.x = f % 2 == 0 ? 1.0f : -1.0f;
        trial.change(s);
        trial.frame();
    }
    s.windSpeed = 0.0f;
    trial.change(s);
    trial.settle();
}

void freeSwing(Trial& trial) {
    SimulationSettings settings;
    settings.dampingTime = 0.0f;
    settings.bendDampingTime = 0.0f;
    settings.airDrag = 0.0f;
    settings.sleepSpeed = 0.0f;
    settings.restGravity = 0.0f;
    settings.gravity = {4.0f, 0.0f, 2.0f};
    trial.start(tuft(kPoints, kSegment), settings);
    trial.frames(6);
    settings = trial.settings();
    settings.gravity = {};
    trial.change(settings);
    const auto meanEnergy = [&] {
        double sum = 0.0;
        for (int f = 0; f < 60; ++f) {
            trial.frame();
            sum += trial.engine().measure().kineticEnergy +
                   bendingEnergy(trial.strands(), settings, trial.positions());
        }
        return sum / 60.0;
    };
    const double start = meanEnergy();
    trial.frames(static_cast<int>(60.0 * (trial.options().freeSeconds - 2.0)));
    trial.expectEnergy("drift of energy", "%",
                       trial.over() ? std::nan("") : 100.0 * std::abs(meanEnergy() / start - 1.0), 1.0);
}

void longRest(Trial& trial) {
    const auto stepsPerFrame = [&] { return std::uint64_t{trial.settings().substeps}; };
    for (const bool sleeps : {true, false}) {
        StrandSet strands;
        strands.addStraight({0.0f, 0.1f, 0.0f}, hangingAt(0.8f), 0.02f, 8);
        SimulationSettings settings;
        if (!sleeps) settings.sleepSpeed = 0.0f;
        trial.start(std::move(strands), settings);
        trial.frames(600);
        const std::vector<Float3> before = trial.positions();
        const std::vector<runtime::RootFrame> roots = trial.strands().roots();
        for (std::uint64_t done = 0; done < trial.options().stepsAtRest && !trial.over();
             done += stepsPerFrame())
            trial.engine().step({kFrame, trial.time(), roots, {}});
        trial.frame();
        const std::vector<Float3> after = trial.positions();
        double drift = 0.0;
        for (std::size_t p = 0; p < after.size(); ++p)
            drift = std::fmax(drift, 1000.0 * static_cast<double>(length(after[p] - before[p])));
        trial.expect(sleeps ? "drift asleep" : "drift awake", "mm", drift, sleeps ? 0.0 : 0.1);
        if (sleeps) {
            const std::uint32_t asleep = trial.engine().measure().asleep;
            trial.expect("strands awake", "", trial.strands().count() - asleep, 0.0);
        }
    }
}

void windThatIsNoNumber(Trial& trial) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    trial.start(tuft());
    trial.frames(60);
    int taken = 0;
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        for (float SimulationSettings::*member :
             {&SimulationSettings::windSpeed, &SimulationSettings::windGustiness,
              &SimulationSettings::airDrag}) {
            SimulationSettings s = trial.settings();
            s.*member = bad;
            if (trial.engine().setSettings(s).empty()) ++taken;
        }
        SimulationSettings s = trial.settings();
        s.windDirection.y = bad;
        if (trial.engine().setSettings(s).empty()) ++taken;
    }
    trial.expect("winds taken that are no number", "", taken, 0.0);

    // Time and poses reach the engine without a check of their own.
    SimulationSettings windy = trial.settings();
    windy.windSpeed = 5.0f;
    trial.change(windy);
    trial.engine().step({kFrame, static_cast<double>(kNan), trial.strands().roots(), {}});
    std::vector<runtime::RootFrame> roots = trial.strands().roots();
    roots[2].position.y = kNan;
    roots[3].rotation.w = kInfinity;
    trial.setRoots(roots);
    trial.setSpheres({{{kNan, 0.0f, 0.0f}, 0.1f}, {{0.0f, 0.0f, 0.0f}, kInfinity}});
    trial.frame();
    const runtime::StepReport report = trial.engine().lastStep();
    trial.expect("bad roots and spheres not reported", "",
                 std::abs(4.0 - report.rejectedRoots - report.rejectedSpheres), 0.0);
    trial.moveRoots({});
    trial.setSpheres({});
    trial.frames(30);

    // A strand that does break is put back and reported: explicit Euler with real hair's stiffness.
    SimulationSettings breaking = trial.settings();
    breaking.integrator = runtime::Integrator::explicitEuler;
    breaking.angularStiffness = 0.99f;
    breaking.lengthIterations = 0;
    breaking.dampingTime = 0.0f;
    SimulationSettings sound = trial.settings();
    sound.windSpeed = 0.0f;
    std::uint32_t restored = 0;
    trial.engine().setSettings(breaking);
    for (int f = 0; f < 60; ++f) {
        trial.engine().step({kFrame, trial.time(), trial.strands().roots(), {}});
        restored += trial.engine().lastStep().restoredStrands;
    }
    trial.expect("broken strands not reported", "", restored > 0 ? 0.0 : 1.0, 0.0);
    // Strands on their way to break when the settings change still count among the broken ones.
    trial.engine().setSettings(sound);
    for (int f = 0; f < 30; ++f) trial.engine().step({kFrame, trial.time(), trial.strands().roots(), {}});
    trial.change(sound);
    trial.settle();

    // And by hand: from there on it is as if nothing had been.
    trial.engine().reset(trial.strands().roots());
    const auto fresh = trial.another(sound);
    for (int f = 0; f < 120 && !trial.over(); ++f) {
        trial.frame();
        fresh->step({kFrame, trial.time(), trial.strands().roots(), {}});
    }
    trial.expect("unlike a fresh start after reset()", "",
                 trial.engine().stateHash() == fresh->stateHash() ? 0.0 : 1.0, 0.0);
}

void denormalSpeeds(Trial& trial) {
    StrandSet strands;
    strands.addStraight({}, {1.0f, 0.0f, 0.0f}, kSegment, kPoints);
    strands.addStraight({}, {0.0f, 0.0f, 1.0f}, kSegment, kPoints);
    SimulationSettings settings;
    settings.gravity = {0.0f, -1e-36f, 0.0f};
    settings.restGravity = 0.0f;
    settings.windSpeed = 1e-38f;
    settings.windKind = runtime::WindKind::uniform;
    trial.start(std::move(strands), settings);
    trial.frames(250);
    trial.expect("speed", "m/s", trial.greatestSpeed(), 1e-4);
    settings = trial.settings();
    settings.gravity = SimulationSettings{}.gravity;
    settings.windSpeed = 0.0f;
    trial.change(settings);
    trial.frames(120);
    trial.settle();
}

}  // namespace hairloom::hardcases
