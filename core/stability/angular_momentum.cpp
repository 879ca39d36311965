// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/angular_momentum.h"

#include <cmath>

#include "core/stability/strand_set.h"
#include "hairloom/engine.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kSpinPoints = 16;
constexpr float kSpinLength = 0.3f;  // metres
constexpr double kSpinFalls = 0.2;   // seconds
constexpr float kSpinFrame = runtime::kUsualFrame;

/// About z through the root; hair weighs 1 per metre.
struct Spin {
    double momentum = 0, inertia = 0;
};

Spin spinOf(const runtime::Engine& engine) {
    std::vector<runtime::Float3> positions(engine.pointCount()), velocities(engine.pointCount());
    engine.readPositions(positions);
    engine.readVelocities(velocities);
    Spin spin;
    const double segment = static_cast<double>(kSpinLength) / (kSpinPoints - 1);
    for (std::size_t p = 1; p < positions.size(); ++p) {
        const double mass = p + 1 < positions.size() ? segment : 0.5 * segment;
        const double x = static_cast<double>(positions[p].x), y = static_cast<double>(positions[p].y);
        const double vx = static_cast<double>(velocities[p].x), vy = static_cast<double>(velocities[p].y);
        spin.momentum += mass * (x * vy - y * vx);
        spin.inertia += mass * (x * x + y * y);
    }
    return spin;
}

/// The authored settings with a free hinge and nothing that brakes.
runtime::SimulationSettings freeOf(runtime::SimulationSettings settings) {
    settings.gravity = {0.0f, -9.81f, 0.0f};
    settings.restGravity = 0.0f;
    settings.dampingTime = 0.0f;
    settings.bendDampingTime = 0.0f;
    settings.airDrag = 0.0f;
    settings.windSpeed = 0.0f;
    settings.sleepSpeed = 0.0f;
    settings.hairHair = false;
    settings.clampedPoints = 1;
    // The spring of the hinge is that of the curve at 0.
    const runtime::Ramp::Key keys[] = {{0.0f, 0.0f}, {0.05f, 1.0f}, {1.0f, 1.0f}};
    settings.angularCurve = runtime::Ramp::of(keys);
    return settings;
}

}  // namespace

double backwardEulerLoss(double rate, double step, double seconds) {
    return 1 - 1 / std::sqrt(1 + 2 * rate * rate * step * seconds);
}

Result<MomentumLoss> angularMomentumLoss(const runtime::SimulationSettings& authored, double seconds) {
    runtime::SimulationSettings settings = freeOf(authored);
    StrandSet strand;
    strand.add({}, {1.0f, 0.0f, 0.0f}, kSpinLength / (kSpinPoints - 1), kSpinPoints);
    auto made = runtime::Engine::make(strand.view(), settings);
    if (!made.engine) return tl::unexpected(errorOfWords(made.error));
    runtime::Engine& engine = *made.engine;
    const std::vector<runtime::RootFrame> roots = strand.roots();
    double time = 0;
    const auto run = [&](double until) {
        for (; time < until - 0.5 * static_cast<double>(kSpinFrame); time += static_cast<double>(kSpinFrame))
            engine.step({kSpinFrame, time, roots, {}});
    };
    run(kSpinFalls);
    settings.gravity = {};
    if (const std::string why = engine.setSettings(settings); !why.empty())
        return tl::unexpected(errorOfWords(why));
    run(time + static_cast<double>(kSpinFrame));  // velocities of the last substep know no gravity then
    const Spin before = spinOf(engine);
    run(time + seconds);
    const Spin after = spinOf(engine);
    MomentumLoss loss;
    loss.rate = std::abs(before.momentum) / before.inertia;
    loss.lost = 1 - after.momentum / before.momentum;
    loss.predicted = backwardEulerLoss(
        loss.rate, static_cast<double>(kSpinFrame) / runtime::substepsIn(settings, kSpinFrame), seconds);
    if (!std::isfinite(loss.lost)) return fail("the strand is not finite", "expected stable settings");
    return loss;
}

}  // namespace hairloom
