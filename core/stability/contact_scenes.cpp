// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/contact_scenes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/stability/hard_cases.h"
#include "core/stability/strand_set.h"
#include "hairloom/engine.h"

namespace hairloom {
namespace {

using runtime::Engine;
using runtime::Float3;
using runtime::RootFrame;
using runtime::SimulationSettings;
using runtime::Sphere;

constexpr double kSceneGravity = 9.81;  // m/s²

Engine engineOf(const StrandSet& strands, const SimulationSettings& settings) {
    Engine::Result made = Engine::make(strands.view(), settings);
    assert(made.engine);
    return std::move(*made.engine);
}

std::vector<Float3> pointsOf(const Engine& engine) {
    std::vector<Float3> points(engine.pointCount());
    engine.readPositions(points);
    return points;
}

StrandSet levelRod(std::uint32_t points, float segment) {
    StrandSet strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, segment, points);
    return strands;
}

SimulationSettings fallingFreely() {
    SimulationSettings s;
    s.restGravity = s.airDrag = s.friction = s.collisionRadiusRoot = s.collisionRadiusTip = s.sleepSpeed =
        0.0f;
    return s;
}

const std::vector<Sphere>& ballBelow() {
    static const std::vector<Sphere> ball{
        {{static_cast<float>(FallingChain::kX), static_cast<float>(FallingChain::kY), 0.0f},
         static_cast<float>(FallingChain::kRadius)}};
    return ball;
}

// The strand over a bar: the bar's axis goes along z through (0, −kBar, 0).
constexpr double kBar = 0.03, kSpan = 0.2, kTail = 0.25, kLink = 0.005;  // metres

/// Level from the root to the top of the bar, a quarter around it, and down.
StrandSet strandOverBar() {
    const double quarter = 0.5 * std::acos(-1.0) * kBar;
    std::vector<Float3> points;
    for (int i = 0; kLink * i <= kSpan + quarter + kTail; ++i) {
        const double along = kLink * i - kSpan, angle = std::clamp(along, 0.0, quarter) / kBar;
        points.push_back({static_cast<float>(std::min(along, 0.0) + kBar * std::sin(angle)),
                          static_cast<float>(kBar * (std::cos(angle) - 1.0) - std::max(along - quarter, 0.0)),
                          0.0f});
    }
    StrandSet strands;
    strands.add(points);
    return strands;
}

/// Rising of a segment by its run, towards the tip.
double slopeOf(const std::vector<Float3>& x, std::size_t segment) {
    return static_cast<double>(x[segment + 1].y - x[segment].y) /
           static_cast<double>(x[segment + 1].x - x[segment].x);
}

/// Of now, in lengths of hair that weigh as much: the catenary between root and bar has the same level pull
/// throughout, and the slope of a segment differs from that of the next by the weight of a node over it.
struct Tensions {
    double root, tip, due, wrap;
};
Tensions tensionsOf(const std::vector<Float3>& x, double friction, double drag) {
    const auto off = [&](std::size_t p) {
        return std::hypot(static_cast<double>(x[p].x), static_cast<double>(x[p].y) + kBar);
    };
    std::size_t touching = 1;  // the first node that does
    while (touching + 1 < x.size() && off(touching) > kBar + 1e-4) ++touching;
    constexpr std::size_t kFirst = 4;
    const std::size_t last = touching - 1;  // of the segments that hang free
    const double start = slopeOf(x, kFirst), end = slopeOf(x, last);
    const double level = kLink * static_cast<double>(last - kFirst) / (end - start);
    // α: of a place on the bar from the side of the tip, where the strand hangs straight down.
    const double tail = -kBar - static_cast<double>(x.back().y),
                 wrap = 0.5 * std::acos(-1.0) + std::atan(end);
    constexpr int kSteps = 1000;
    double due = tail * (1.0 + drag);
    for (int i = 0; i < kSteps; ++i) {
        const double alpha = wrap * (i + 0.5) / kSteps;
        due += wrap / kSteps * (kBar * std::cos(alpha) + friction * (due + kBar * std::sin(alpha)));
    }
    return {level * std::sqrt(1.0 + end * end), tail, due, wrap};
}

}  // namespace

FallOnASphere::FallOnASphere() : frames_(1) {
    for (int f = 0; f < 48; ++f) {
        FallingChain next = frames_.back();
        next.run(1.0 / 60.0, 400);
        frames_.push_back(next);
    }
}

double FallOnASphere::error(std::uint32_t substeps) const {
    const StrandSet strands = levelRod(FallingChain::kFree + 2, static_cast<float>(FallingChain::kSegment));
    SimulationSettings s = fallingFreely();
    s.angularStiffness = 0.5f;
    s.substeps = substeps;
    Engine engine = engineOf(strands, s);
    const auto roots = strands.roots();
    double sum = 0.0;
    for (std::size_t f = 1; f < frames_.size(); ++f) {
        engine.step({runtime::kUsualFrame, static_cast<double>(f) / 60.0, roots, ballBelow()});
        const std::vector<Float3> x = pointsOf(engine);
        for (int p = 1; p <= FallingChain::kFree; ++p) {
            const Float3& point = x[static_cast<std::size_t>(p) + 1];
            const double dx = static_cast<double>(point.x) - frames_[f].x(p);
            const double dy = static_cast<double>(point.y) - frames_[f].y(p);
            sum += dx * dx + dy * dy;
        }
    }
    return std::sqrt(sum / (static_cast<double>(frames_.size() - 1) * FallingChain::kFree));
}

Slide slideOnAPlane(double over, std::uint32_t substeps) {
    const double angle = std::atan(0.3 * over);
    SimulationSettings s = fallingFreely();
    s.dampingTime = s.bendDampingTime = 0.0f;
    s.clampedPoints = 1;
    s.angularStiffness = 1e-6f;
    s.friction = 0.3f;
    s.substeps = substeps;
    s.gravity = {0.0f, static_cast<float>(-kSceneGravity * std::cos(angle)),
                 static_cast<float>(kSceneGravity * std::sin(angle))};
    const StrandSet strands = levelRod(2, 1.0f);
    Engine engine = engineOf(strands, s);
    const auto roots = strands.roots();
    // A plane for a point that turns about the root: it stays on the circle where this sphere is at y = 0.
    const std::vector<Sphere> plane{{{0.0f, -std::sqrt(1000.0f * 1000.0f - 1.0f), 0.0f}, 1000.0f}};
    double turn = 0.0, rate = 0.0;
    for (int f = 1; f <= 60; ++f) {
        engine.step({runtime::kUsualFrame, f / 60.0, roots, plane});
        for (int i = 0; i < 1000; ++i) {
            const double pull = kSceneGravity * (std::sin(angle) * std::cos(turn) - 0.3 * std::cos(angle));
            rate = std::max(0.0, rate + pull / 60000.0);
            turn += rate / 60000.0;
        }
    }
    return {static_cast<double>(pointsOf(engine)[1].z), std::sin(turn)};
}

Capstan strandOverABar(float friction, std::uint32_t substeps) {
    constexpr float kPullSpeed = 0.03f, kDamping = 0.5f;  // m/s, seconds
    constexpr int kFalling = 60, kPulling = 50, kMeasured = 90;
    SimulationSettings s = fallingFreely();
    s.clampedPoints = 1;
    s.angularStiffness = 1e-6f;
    s.friction = friction;
    s.substeps = substeps;
    s.dampingTime = kDamping;
    const StrandSet strands = strandOverBar();
    Engine engine = engineOf(strands, s);
    const std::vector<Sphere> ends{{{0.0f, static_cast<float>(-kBar), -0.1f}, static_cast<float>(kBar)},
                                   {{0.0f, static_cast<float>(-kBar), 0.1f}, static_cast<float>(kBar)}};
    const std::vector<runtime::Capsule> bar{{0, 1}};
    // Nodes that come to the bar shake the catenary: means are of one over the tension, which is its sag.
    double found = 0.0, due = 0.0, wrap = 0.0;
    for (int f = 1; f <= kFalling + kPulling + kMeasured; ++f) {
        const float way = kPullSpeed * runtime::kUsualFrame * static_cast<float>(std::max(0, f - kFalling));
        const std::vector<RootFrame> roots = strands.roots({-way, 0.0f, 0.0f});
        runtime::FrameInput input;
        input.dt = runtime::kUsualFrame;
        input.time = f / 60.0;
        input.roots_ws = roots;
        input.spheres = ends;
        input.capsules = bar;
        engine.step(input);
        if (f <= kFalling + kPulling) continue;
        const double drag = static_cast<double>(kPullSpeed / kDamping) / kSceneGravity;
        const Tensions now = tensionsOf(pointsOf(engine), static_cast<double>(friction), drag);
        found += now.tip / now.root / kMeasured;
        due += now.tip / now.due / kMeasured;
        wrap += now.wrap / kMeasured;
    }
    return {1.0 / found, 1.0 / due, wrap};
}

Bounce bounceOnASphere(float restitution) {
    const StrandSet strands = levelRod(24, 0.0125f);
    SimulationSettings s = fallingFreely();
    s.restitution = restitution;
    Engine damped = engineOf(strands, s);
    s.dampingTime = s.bendDampingTime = 0.0f;
    Engine undamped = engineOf(strands, s);
    const auto roots = strands.roots();
    const double start = undamped.measure().potentialEnergy;
    Bounce bounce;
    for (int f = 1; f <= 900; ++f) {
        damped.step({runtime::kUsualFrame, f / 60.0, roots, ballBelow()});
        undamped.step({runtime::kUsualFrame, f / 60.0, roots, ballBelow()});
        const runtime::Measurements m = undamped.measure();
        bounce.gained = std::max(bounce.gained, m.kineticEnergy + m.potentialEnergy - start);
    }
    bounce.speed = damped.measure().fastest;
    return bounce;
}

std::uint32_t guardedWhereGravityChanges() {
    const StrandSet strands = levelRod(16, 0.012f);
    SimulationSettings s = fallingFreely();
    s.dampingTime = 0.0f;
    Engine engine = engineOf(strands, s);
    const auto roots = strands.roots();
    std::uint32_t guarded = 0;
    for (int f = 1; f <= 240; ++f) {
        s.gravity.y = static_cast<float>(-kSceneGravity * (1.0 + 0.1 * std::sin(0.7 * f)));
        engine.setSettings(s);
        engine.step({runtime::kUsualFrame, f / 60.0, roots, {}});
        guarded += engine.lastStep().guardedStrands;
    }
    return guarded;
}

double speedAfterStorm(std::uint32_t seed) {
    HardCaseRun run(kRods, {});
    hardcases::runStorm(run, seed);
    run.frames(600);
    return run.greatestSpeed();
}

}  // namespace hairloom
