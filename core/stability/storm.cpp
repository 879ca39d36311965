// SPDX-License-Identifier: GPL-3.0-or-later
// One random storm: everything that moves hair, at once.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/stability/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::Float3;

class Dice {
  public:
    explicit Dice(std::uint64_t seed) : random_(seed) {}
    float between(float low, float high) { return low + (high - low) * random_.uniform(); }
    /// Evenly over orders of magnitude.
    float spread(float low, float high) { return low * std::pow(high / low, random_.uniform()); }
    bool oneIn(int count) { return random_.uniform() * static_cast<float>(count) < 1.0f; }
    Float3 inBox(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

  private:
    Random random_;
};

StrandSet stormHair(Dice& dice) {
    const auto points = static_cast<std::uint32_t>(dice.spread(3.0f, 200.0f));
    StrandSet strands;
    if (dice.oneIn(2)) {
        strands.add({}, hangingAt(dice.between(-3.0f, 3.0f)),
                    dice.spread(0.005f, 1.5f) / static_cast<float>(points - 1), points);
        return strands;
    }
    const float radius = dice.spread(0.001f, 0.03f), pitch = dice.spread(0.002f, 0.05f);
    const float turns = std::min(dice.between(0.5f, 8.0f), static_cast<float>(points) / 6.0f);
    std::vector<Float3> curl;
    for (std::uint32_t p = 0; p < points; ++p) {
        const float t =
            2.0f * std::numbers::pi_v<float> * turns * static_cast<float>(p) / static_cast<float>(points - 1);
        curl.push_back({radius * (std::cos(t) - 1.0f), -pitch * t / (2.0f * std::numbers::pi_v<float>),
                        radius * std::sin(t)});
    }
    strands.add(curl);
    return strands;
}

runtime::SimulationSettings stormSettings(Dice& dice) {
    runtime::SimulationSettings settings;
    settings.angularStiffness = dice.between(0.05f, 0.97f);
    settings.restGravity = dice.oneIn(2) ? 0.0f : 1.0f;
    settings.bendDampingTime = dice.oneIn(2) ? 0.0f : 0.03f;
    settings.clampedPoints = dice.oneIn(2) ? 1 : 2;
    settings.torsionRatio = dice.spread(0.3f, 2.0f);
    settings.sleepSpeed = 0.0f;
    settings.teleportDistance = 10000.0f;
    settings.windKind = runtime::WindKind::gusting;
    return settings;
}

}  // namespace

double runStorm(HardCaseRun& caseRun, std::uint32_t seed) {
    Dice dice(0x5707u + seed);
    StrandSet hair = stormHair(dice);
    caseRun.restart(std::move(hair), stormSettings(dice));
    std::vector<runtime::Sphere> spheres(dice.oneIn(3) ? 2 : dice.oneIn(2) ? 1 : 0);
    for (runtime::Sphere& sphere : spheres) sphere.radius = dice.spread(0.01f, 0.2f);
    Float3 shift{};
    runtime::Quat turn{};
    for (int f = 0; f < 120; ++f) {
        if (dice.oneIn(4)) shift = dice.inBox(5.0f);
        if (dice.oneIn(3)) {
            const Float3 axis = dice.inBox(1.0f);
            turn = {axis.x, axis.y, axis.z, 0.1f};
            runtime::normalize(turn);
        }
        caseRun.moveRoots(shift, turn);
        for (runtime::Sphere& sphere : spheres) sphere.center_ws = shift + dice.inBox(0.5f);
        caseRun.setSpheres(spheres);
        runtime::SimulationSettings settings = caseRun.settings();
        settings.windSpeed = dice.oneIn(2) ? dice.between(0.0f, 200.0f) : 0.0f;
        settings.windDirection = dice.inBox(1.0f);
        caseRun.change(settings);
        caseRun.frame(dice.spread(0.001f, 1.0f));
    }
    runtime::SimulationSettings settings = caseRun.settings();
    settings.windSpeed = 0.0f;
    caseRun.change(settings);
    caseRun.frames(300);
    return caseRun.greatestSpeed();
}

}  // namespace hairloom::hardcases
