// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One strand and the frames of its root, for the engine and the reference alike.

#include <cmath>
#include <vector>

#include "hairloom/engine.h"
#include "tests/simulation/reference_fixture.h"

namespace hairloom::test {

inline constexpr float kFrameTime = 1.0f / 60.0f;

/// One strand and the frames of its root, in the form of either solver.
struct Swing {
    reference::Strands strands;
    std::vector<reference::Frame> frames;
};

/// The root swings on a circle's arc and turns with it, from rest smoothly; whole frames at kFrameTime.
inline Swing swing(const reference::Strands& strands, std::size_t frames) {
    Swing result{strands, {}};
    for (std::size_t f = 1; f <= frames; ++f) {
        const double t = static_cast<double>(f) * static_cast<double>(kFrameTime);
        const double angle = 0.5 * std::pow(std::sin(0.5 * kTau * t), 2.0);
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Vec3d::UnitZ()));
        const Vec3d position(0.1 * std::sin(angle), 0.1 * (1.0 - std::cos(angle)), 0.0);
        result.frames.push_back({static_cast<double>(kFrameTime), t, {reference::Root{position, turn}}, {}});
    }
    return result;
}

inline runtime::Float3 toFloat3(const Vec3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline runtime::SimulationSettings withSteps(runtime::SimulationSettings s, runtime::Integrator integrator,
                                             std::uint32_t substeps) {
    s.integrator = integrator;
    s.substeps = substeps;
    s.sleepSpeed = 0.0f;
    return s;
}

/// Points at the end of each frame.
inline std::vector<std::vector<Vec3d>> engineRun(const Swing& swing, const runtime::SimulationSettings& s) {
    std::vector<runtime::Float3> rest;
    for (const Vec3d& p : swing.strands.restPositions_ss) rest.push_back(toFloat3(p));
    const std::vector<float> stiffness(swing.strands.stiffness.begin(), swing.strands.stiffness.end());
    runtime::Engine::Result made = runtime::Engine::make({swing.strands.offsets, rest, {}, {}, stiffness}, s);
    EXPECT_EQ(made.error, "");
    std::vector<std::vector<Vec3d>> result;
    std::vector<runtime::Float3> points(rest.size());
    for (const reference::Frame& frame : swing.frames) {
        const Eigen::Vector4f q = frame.roots_ws[0].rotation.coeffs().cast<float>();
        const runtime::RootFrame root{toFloat3(frame.roots_ws[0].position), {q.x(), q.y(), q.z(), q.w()}};
        std::vector<runtime::Sphere> spheres;
        for (const reference::Sphere& sphere : frame.spheres)
            spheres.push_back({toFloat3(sphere.center_ws), static_cast<float>(sphere.radius)});
        runtime::FrameInput input{static_cast<float>(frame.dt), frame.time, {&root, 1}};
        input.spheres = spheres;
        std::vector<runtime::Capsule> capsules;
        for (const auto& [first, second] : frame.capsules)
            capsules.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second)});
        input.capsules = capsules;
        made.engine->step(input);
        made.engine->readPositions(points);
        result.emplace_back();
        for (const runtime::Float3 p : points) {
            result.back().emplace_back(static_cast<double>(p.x), static_cast<double>(p.y),
                                       static_cast<double>(p.z));
        }
    }
    return result;
}

inline double rmsMm(const std::vector<std::vector<Vec3d>>& a, const std::vector<std::vector<Vec3d>>& b) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t f = 0; f < a.size(); ++f) {
        for (std::size_t p = 0; p < a[f].size(); ++p, ++count) sum += (a[f][p] - b[f][p]).squaredNorm();
    }
    return 1e3 * std::sqrt(sum / static_cast<double>(count));
}

}  // namespace hairloom::test
