// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: stiffness, storms, energy, rest and input that is no number.
#include <cmath>
#include <limits>

#include "core/stability/hard_cases.h"

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

void stiffnessTimesMillion(HardCaseRun& caseRun) {
    SimulationSettings settings;
    settings.angularStiffness = stiffer(settings.angularStiffness, 1e6);
    caseRun.start(tuft(), settings);
    caseRun.shakeRoots();
    caseRun.frames(190);
    caseRun.settle();
}

void reversingStorm(HardCaseRun& caseRun) {
    SimulationSettings settings;
    settings.windKind = runtime::WindKind::uniform;
    settings.windSpeed = 100.0f;
    caseRun.start(tuft(), settings);
    SimulationSettings s = caseRun.settings();
    for (int f = 0; f < 250; ++f) {
        s.windDirection.x = f % 2 == 0 ? 1.0f : -1.0f;
        caseRun.change(s);
        caseRun.frame();
    }
    s.windSpeed = 0.0f;
    caseRun.change(s);
    caseRun.settle();
}

void freeSwing(HardCaseRun& caseRun) {
    if (!caseRun.method().rods())
        caseRun.disclaim("springs fix lengths after bending, which does not conserve energy without damping");
    SimulationSettings settings;
    settings.dampingTime = 0.0f;
    settings.bendDampingTime = 0.0f;
    settings.airDrag = 0.0f;
    settings.sleepSpeed = 0.0f;
    settings.restGravity = 0.0f;
    settings.gravity = {4.0f, 0.0f, 2.0f};
    caseRun.start(tuft(kPoints, kSegment), settings);
    caseRun.frames(6);
    settings = caseRun.settings();
    settings.gravity = {};
    caseRun.change(settings);
    const auto meanEnergy = [&] {
        double sum = 0.0;
        for (int f = 0; f < 60; ++f) {
            caseRun.frame();
            sum += caseRun.engine().measure().kineticEnergy +
                   bendingEnergy(caseRun.strands(), settings, caseRun.positions());
        }
        return sum / 60.0;
    };
    const double start = meanEnergy();
    caseRun.frames(static_cast<int>(60.0 * (caseRun.options().freeSeconds - 2.0)));
    const double gained = caseRun.over() ? std::nan("") : 100.0 * (meanEnergy() / start - 1.0);
    // The steps of rods take energy out of fast waves; they add none.
    if (caseRun.method().rods()) {
        caseRun.expectEnergy("energy gained", "%", std::isnan(gained) ? gained : std::max(gained, 0.0), 1.0);
    } else {
        caseRun.expectEnergy("drift of energy", "%", std::abs(gained), 1.0);
    }
}

void longRest(HardCaseRun& caseRun) {
    const auto stepsPerFrame = [&] { return std::uint64_t{caseRun.settings().substeps}; };
    for (const bool sleeps : {true, false}) {
        StrandSet strands;
        strands.add({0.0f, 0.1f, 0.0f}, hangingAt(0.8f), 0.02f, 8);
        SimulationSettings settings;
        if (!sleeps) settings.sleepSpeed = 0.0f;
        caseRun.start(std::move(strands), settings);
        caseRun.frames(600);
        const std::vector<Float3> before = caseRun.positions();
        const std::vector<runtime::RootFrame> roots = caseRun.strands().roots();
        for (std::uint64_t done = 0; done < caseRun.options().stepsAtRest && !caseRun.over();
             done += stepsPerFrame())
            caseRun.engine().step({kFrame, caseRun.time(), roots, {}});
        caseRun.frame();
        const std::vector<Float3> after = caseRun.positions();
        double drift = 0.0;
        for (std::size_t p = 0; p < after.size(); ++p)
            drift = std::fmax(drift, 1000.0 * static_cast<double>(length(after[p] - before[p])));
        caseRun.expect(sleeps ? "drift asleep" : "drift awake", "mm", drift, sleeps ? 0.0 : 0.1);
        if (sleeps) {
            const std::uint32_t asleep = caseRun.engine().measure().asleep;
            caseRun.expect("strands awake", "", caseRun.strands().count() - asleep, 0.0);
        }
    }
}

void windThatIsNoNumber(HardCaseRun& caseRun) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    caseRun.start(tuft());
    caseRun.frames(60);
    int taken = 0;
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        for (float SimulationSettings::*member :
             {&SimulationSettings::windSpeed, &SimulationSettings::windGustiness,
              &SimulationSettings::airDrag}) {
            SimulationSettings s = caseRun.settings();
            s.*member = bad;
            if (caseRun.engine().setSettings(s).empty()) ++taken;
        }
        SimulationSettings s = caseRun.settings();
        s.windDirection.y = bad;
        if (caseRun.engine().setSettings(s).empty()) ++taken;
    }
    caseRun.expect("winds accepted that are not finite", "", taken, 0.0);

    // Time and poses reach the engine without a check of their own.
    SimulationSettings windy = caseRun.settings();
    windy.windSpeed = 5.0f;
    caseRun.change(windy);
    caseRun.engine().step({kFrame, static_cast<double>(kNan), caseRun.strands().roots(), {}});
    std::vector<runtime::RootFrame> roots = caseRun.strands().roots();
    roots[2].position.y = kNan;
    roots[3].rotation.w = kInfinity;
    caseRun.setRoots(roots);
    caseRun.setSpheres({{{kNan, 0.0f, 0.0f}, 0.1f}, {{0.0f, 0.0f, 0.0f}, kInfinity}});
    caseRun.frame();
    const runtime::StepReport report = caseRun.engine().lastStep();
    caseRun.expect("bad roots and spheres not reported", "",
                   std::abs(4.0 - report.rejectedRoots - report.rejectedSpheres), 0.0);
    caseRun.moveRoots({});
    caseRun.setSpheres({});
    caseRun.frames(30);

    // A strand that does break is put back and reported: explicit Euler with real hair's stiffness.
    SimulationSettings breaking = caseRun.settings();
    breaking.strandModel = runtime::StrandModel::springs;
    breaking.integrator = runtime::Integrator::explicitEuler;
    breaking.angularStiffness = 0.99f;
    breaking.lengthIterations = 0;
    breaking.dampingTime = 0.0f;
    SimulationSettings sound = caseRun.settings();
    sound.windSpeed = 0.0f;
    std::uint32_t restored = 0;
    caseRun.engine().setSettings(breaking);
    for (int f = 0; f < 60; ++f) {
        caseRun.engine().step({kFrame, caseRun.time(), caseRun.strands().roots(), {}});
        restored += caseRun.engine().lastStep().restoredStrands;
    }
    caseRun.expect("broken strands not reported", "", restored > 0 ? 0.0 : 1.0, 0.0);
    // Strands on their way to break when the settings change still count among the broken ones.
    caseRun.engine().setSettings(sound);
    for (int f = 0; f < 30; ++f)
        caseRun.engine().step({kFrame, caseRun.time(), caseRun.strands().roots(), {}});
    caseRun.change(sound);
    caseRun.settle();

    // And by hand: from there on it is as if nothing had been.
    caseRun.engine().reset(caseRun.strands().roots());
    const auto fresh = caseRun.another(sound);
    for (int f = 0; f < 120 && !caseRun.over(); ++f) {
        caseRun.frame();
        fresh->step({kFrame, caseRun.time(), caseRun.strands().roots(), {}});
    }
    caseRun.expect("unlike a fresh start after reset()", "",
                   caseRun.engine().stateHash() == fresh->stateHash() ? 0.0 : 1.0, 0.0);
}

void denormalSpeeds(HardCaseRun& caseRun) {
    StrandSet strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, kSegment, kPoints);
    strands.add({}, {0.0f, 0.0f, 1.0f}, kSegment, kPoints);
    SimulationSettings settings;
    settings.gravity = {0.0f, -1e-36f, 0.0f};
    settings.restGravity = 0.0f;
    settings.windSpeed = 1e-38f;
    settings.windKind = runtime::WindKind::uniform;
    caseRun.start(std::move(strands), settings);
    caseRun.frames(250);
    caseRun.expect("speed", "m/s", caseRun.greatestSpeed(), 1e-4);
    settings = caseRun.settings();
    settings.gravity = SimulationSettings{}.gravity;
    settings.windSpeed = 0.0f;
    caseRun.change(settings);
    caseRun.frames(120);
    caseRun.settle();
}

}  // namespace hairloom::hardcases
