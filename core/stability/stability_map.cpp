// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/stability_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/parallel.h"
#include "core/stability/stability.h"
#include "core/stability/strand_set.h"
#include "hairloom/engine.h"
#include "hairloom/stable.h"

namespace hairloom {
namespace {

using runtime::Float3;
using runtime::Integrator;
using runtime::SimulationSettings;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kGrowth = 3.0;
constexpr std::uint32_t kPoints = 9;
constexpr float kSegment = 0.01f;
/// A longer step is several.
constexpr double kLongestStep = 1.0 / 60;
/// Metres that the push moves the strand in a step: far above rounding, far below a segment.
constexpr double kPush = 2e-4;
constexpr double kStrongest = 1000.0;  // m/s², of gravity
/// What the swing begins with.
constexpr std::uint32_t kFirstSteps = 10;
/// Distance from the theoretical border within which either side is right, as a share of ω h.
constexpr double kBorder = 0.1;
/// Likewise for explicit Euler, beyond: the fastest wave, at first a small part of the swing, has to outgrow
/// it.
constexpr double kEulerBorder = 2.0;

StrandSet mappedStrand() {
    StrandSet strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, kSegment, kPoints);
    return strands;
}

SimulationSettings mappedSettings(Integrator integrator, MappedForce force, double stiffness) {
    SimulationSettings s;
    s.strandModel = runtime::StrandModel::springs;
    s.integrator = integrator;
    s.substeps = 1;
    s.dampingTime = 0.0f;
    s.bendDampingTime = 0.0f;
    s.airDrag = 0.0f;
    s.sleepSpeed = 0.0f;
    s.restGravity = 0.0f;
    s.angularCurve = {};
    s.lengthIterations = 0;
    s.gravity = {};
    if (force == MappedForce::coils) {
        s.lengthMethod = runtime::LengthMethod::springs;
        s.springFrequency = static_cast<float>(stiffness);
        s.angularStiffness = 0.0f;
    } else {
        s.angularStiffness = static_cast<float>(stiffness);
    }
    return s;
}

/// Root mean square speed of the points: of an undamped swing, the root of its energy at its greatest.
/// Infinite when one is no number.
double swingOf(const runtime::Engine& engine, std::vector<Float3>& velocities) {
    engine.readVelocities(velocities);
    double sum = 0.0;
    for (const Float3& v : velocities) sum += static_cast<double>(dot(v, v));
    return std::isfinite(sum) ? std::sqrt(sum / static_cast<double>(velocities.size())) : kInfinite;
}

std::vector<double> logarithmic(double low, double high, std::uint32_t count) {
    std::vector<double> values;
    for (std::uint32_t i = 0; i < count; ++i)
        values.push_back(low * std::pow(high / low, i / std::max(1.0, count - 1.0)));
    return values;
}

/// s of angularStiffness spread evenly in the logarithm of s/(1 − s), to which the bending stiffness is
/// proportional.
std::vector<double> stiffnessRows(MappedForce force, std::uint32_t count) {
    if (force == MappedForce::coils) return logarithmic(10.0, 2000.0, count);
    std::vector<double> rows = logarithmic(0.01, 100.0, count);
    for (double& ratio : rows) ratio = ratio / (1.0 + ratio);
    return rows;
}

/// The height at which a row is drawn.
double drawnRow(MappedForce force, double stiffness) {
    return force == MappedForce::coils ? stiffness : stiffness / (1.0 - stiffness);
}

}  // namespace

const char* forceName(MappedForce force) {
    return force == MappedForce::coils ? "coils" : "angular";
}

double fastestWave(Integrator integrator, MappedForce force, double stiffness) {
    const StrandSet strands = mappedStrand();
    const runtime::FastestWaves waves =
        runtime::fastestWaves(strands.view(), mappedSettings(integrator, force, stiffness));
    return force == MappedForce::coils ? waves.coils : waves.bending;
}

double theoreticalLimit(Integrator integrator, MappedForce force, std::uint32_t steps) {
    switch (integrator) {
        case Integrator::implicitEuler:
            return kInfinite;
        case Integrator::verlet:
            return force == MappedForce::angular ? kInfinite : 2.0;
        case Integrator::velocityVerlet:
        case Integrator::leapfrog:
            return 2.0;
        case Integrator::rk4:
            return 2.0 * std::numbers::sqrt2;
        case Integrator::explicitEuler:
            break;
    }
    // (1 + ω²h²)^(n/2) = kGrowth.
    return std::sqrt(std::pow(kGrowth, 2.0 / steps) - 1.0);
}

StabilityProbe probeStability(Integrator integrator, MappedForce force, double h, double stiffness,
                              std::uint32_t steps) {
    const StrandSet strands = mappedStrand();
    SimulationSettings settings = mappedSettings(integrator, force, stiffness);
    StabilityProbe probe;
    probe.adviceFactor = runtime::stableRegion(strands.view(), settings, static_cast<float>(h)).factor;
    probe.omegaStep = h * fastestWave(integrator, force, stiffness);
    // As strong as settings allow, for as many steps as it takes.
    const double strength = std::min(kPush / (h * h), kStrongest);
    const auto bounded = static_cast<float>(strength);
    settings.gravity =
        force == MappedForce::coils ? Float3{bounded, 0.0f, 0.0f} : Float3{0.0f, bounded, 0.0f};
    runtime::Engine::Result made = runtime::Engine::make(strands.view(), settings);
    if (!made.engine) return probe;
    runtime::Engine& engine = *made.engine;
    const std::vector<runtime::RootFrame> roots = strands.roots();
    const runtime::FrameInput input{static_cast<float>(h), 0.0, roots, {}};
    std::vector<Float3> velocities(strands.points.size());
    double first = 0.0, last = 0.0;
    for (int i = 0; i < std::lround(kPush / (h * h) / strength); ++i) {
        engine.step(input);
        first = std::max(first, swingOf(engine, velocities));
    }
    settings.gravity = {};
    engine.setSettings(settings);

    for (std::uint32_t i = 0; i < steps && std::isfinite(last); ++i) {
        engine.step(input);
        if (engine.lastStep().restoredStrands > 0) last = kInfinite;
        const double swing = swingOf(engine, velocities);
        if (i < kFirstSteps) first = std::max(first, swing);
        if (i >= steps - steps / 4 || !std::isfinite(swing)) last = std::max(last, swing);
    }
    probe.growth = first > 0.0 ? last / first : last;
    probe.stable = probe.growth <= kGrowth;
    return probe;
}

StabilityMap mapStability(Integrator integrator, MappedForce force, std::uint32_t cells,
                          std::uint32_t steps) {
    StabilityMap map{
        integrator, force, steps, logarithmic(5e-5, kLongestStep, cells), stiffnessRows(force, cells), {}};
    map.limit = theoreticalLimit(integrator, force, steps);
    map.probes.resize(map.stepSeconds.size() * map.stiffnesses.size());
    parallelFor(map.probes.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            map.probes[i] = probeStability(integrator, force, map.stepSeconds[i % cells],
                                           map.stiffnesses[i / cells], steps);
        }
    });
    const double beyond = integrator == Integrator::explicitEuler ? kEulerBorder : kBorder;
    for (const StabilityProbe& probe : map.probes) {
        const double place = probe.omegaStep / map.limit;
        if (probe.stable ? place > 1.0 + beyond : place < 1.0 - kBorder) ++map.surprises;
    }
    return map;
}

Plot stabilityPlot(const StabilityMap& map) {
    Plot plot;
    const bool coils = map.force == MappedForce::coils;
    plot.title =
        fmt::format("{}, {} springs: stable steps", nameOf(map.integrator), coils ? "coil" : "angular");
    plot.note = fmt::format(
        "A strand of 8 segments, undamped, pushed once, {} steps per cell. Stable: its swing does not grow "
        "threefold. The line is the theory: {}.",
        map.steps,
        std::isfinite(map.limit) ? fmt::format("ω·h = {:.3g}", map.limit) : std::string("no limit"));
    plot.x = {.title = "time step", .unit = "ms", .scale = Scale::Logarithmic};
    plot.y = {.title = coils ? "frequency of the springs" : "stiffness s/(1 − s)",
              .unit = coils ? "Hz" : "",
              .scale = Scale::Logarithmic};
    FilledMap filled;
    std::vector<double> columns, rows;
    for (const double h : map.stepSeconds) columns.push_back(1000.0 * h);
    for (const double s : map.stiffnesses) rows.push_back(drawnRow(map.force, s));
    filled.xEdges = cellEdges(columns, Scale::Logarithmic);
    filled.yEdges = cellEdges(rows, Scale::Logarithmic);
    filled.categories = {{"stable", "#9ecae1"}, {"unstable", "#e6704a"}};
    for (const StabilityProbe& probe : map.probes) filled.values.push_back(probe.stable ? 0.0 : 1.0);
    plot.x.low = filled.xEdges.front(), plot.x.high = filled.xEdges.back();
    plot.y.low = filled.yEdges.front(), plot.y.high = filled.yEdges.back();
    plot.map = std::move(filled);

    Series border{.name = "theory", .colour = "#000000", .marker = Marker::None, .line = LineStyle::Solid};
    for (std::size_t r = 0; r < rows.size() && std::isfinite(map.limit); ++r) {
        const double h = map.limit / fastestWave(map.integrator, map.force, map.stiffnesses[r]);
        if (1000.0 * h < *plot.x.low || 1000.0 * h > *plot.x.high) continue;
        border.points.push_back({1000.0 * h, rows[r]});
    }
    if (!border.points.empty()) plot.series.push_back(std::move(border));
    return plot;
}

}  // namespace hairloom
