// SPDX-License-Identifier: GPL-3.0-or-later
// How much angular momentum strands lose that nothing acts on, by model, method, integrator and substeps.

#include <fmt/format.h>

#include <cmath>

#include "benchmarks/benchmark.h"
#include "core/charts/plot.h"
#include "core/stability/angular_momentum.h"

namespace hairloom::benchmarks {
namespace {

using runtime::AngularMethod;
using runtime::Integrator;
using runtime::LengthMethod;
using runtime::SimulationSettings;
using runtime::StrandModel;

struct Method {
    std::string name;
    SimulationSettings settings;
};

Method springs(std::string name, Integrator integrator, AngularMethod angular, LengthMethod length) {
    Method method{std::move(name), {}};
    method.settings.strandModel = StrandModel::springs;
    method.settings.integrator = integrator;
    method.settings.angularMethod = angular;
    method.settings.lengthMethod = length;
    return method;
}

std::vector<Method> methods() {
    std::vector<Method> all{{"rods", {}}};
    const auto add = [&](const char* name, Integrator integrator, AngularMethod angular,
                         LengthMethod length) { all.push_back(springs(name, integrator, angular, length)); };
    constexpr auto kHeld = LengthMethod::constraint, kCoils = LengthMethod::springs;
    add("implicit angular springs, lengths held, Verlet", Integrator::verlet, AngularMethod::implicit, kHeld);
    add("angular springs, lengths held, velocity Verlet", Integrator::velocityVerlet,
        AngularMethod::smallAngle, kHeld);
    add("angular springs, lengths held, Runge-Kutta", Integrator::rk4, AngularMethod::smallAngle, kHeld);
    add("flexion springs, lengths held, Verlet", Integrator::verlet, AngularMethod::flexion, kHeld);
    add("flexion and coil springs, Verlet", Integrator::verlet, AngularMethod::flexion, kCoils);
    add("angular springs, lengths held, backward Euler", Integrator::implicitEuler, AngularMethod::smallAngle,
        kHeld);
    add("angular and coil springs, backward Euler", Integrator::implicitEuler, AngularMethod::smallAngle,
        kCoils);
    return all;
}

/// From this share on a strand does not spin: the steps are too long for its springs.
constexpr double kTumbles = 0.5;

struct Row {
    std::string name;
    std::vector<std::optional<MomentumLoss>> losses;  ///< by substeps; none where it is not finite
};

std::string percent(double share) {
    return fmt::format("{:.1f}", 100 * share + 0.0);
}

std::string markdownOf(const std::vector<std::uint32_t>& substeps, const std::vector<Row>& rows,
                       const std::string& command) {
    std::string text = fmt::format(
        "Share of the angular momentum, in %, that a strand of 30 cm and 16 points loses in a second of free "
        "spin about its root. `{}`\n\n| method |",
        command);
    for (const std::uint32_t count : substeps) text += fmt::format(" {} substeps |", count);
    text += "\n|---|";
    for (std::size_t i = 0; i < substeps.size(); ++i) text += "---|";
    text += "\n";
    const auto line = [&](const std::string& name, const auto& cell, const Row& row) {
        text += fmt::format("| {} |", name);
        for (const auto& loss : row.losses) {
            const bool spins = loss && std::abs(loss->lost) < kTumbles;
            text += spins ? fmt::format(" {} |", cell(*loss)) : " tumbles |";
        }
        text += "\n";
    };
    for (const Row& row : rows)
        line(
            row.name, [](const MomentumLoss& loss) { return percent(loss.lost); }, row);
    line(
        "radians a second at the start, rods",
        [](const MomentumLoss& loss) { return fmt::format("{:.2f}", loss.rate); }, rows.front());
    line(
        "formula of backward Euler at that rate",
        [](const MomentumLoss& loss) { return percent(loss.predicted); }, rows.front());
    return text;
}

std::string figureOf(const std::vector<std::uint32_t>& substeps, const std::vector<Row>& rows) {
    Plot plot;
    plot.title = "Angular momentum that free strands lose in a second";
    plot.note = "30 cm, 16 points, about 10 radians a second about the root";
    const std::vector<double> counts(substeps.begin(), substeps.end());
    plot.x = {.title = "substeps", .scale = Scale::Logarithmic, .ticks = ticksAt(counts)};
    plot.y = {.title = "lost", .unit = "%"};
    const auto add = [&](const std::string& name, LineStyle line, const Row& row, const auto& value) {
        Series series{.name = name, .marker = Marker::Circle, .line = line};
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (row.losses[i]) series.points.push_back({counts[i], 100 * value(*row.losses[i])});
        }
        plot.series.push_back(std::move(series));
    };
    for (const Row& row : rows)
        add(row.name, LineStyle::Solid, row, [](const MomentumLoss& loss) { return loss.lost; });
    add("formula of backward Euler", LineStyle::Dashed, rows.front(),
        [](const MomentumLoss& loss) { return loss.predicted; });
    return svg(plot);
}

Result<Outcome> runMomentum(const Options& options) {
    const std::vector<std::uint32_t> substeps =
        options.quick ? std::vector<std::uint32_t>{8, 16} : std::vector<std::uint32_t>{2, 4, 8, 16, 32, 64};
    std::vector<Row> rows;
    Report report = Report::array();
    const std::vector<Method> all = methods();
    for (const Method& method : all) {
        Row row{method.name, {}};
        for (const std::uint32_t count : substeps) {
            SimulationSettings settings = method.settings;
            settings.substeps = count;
            const auto loss = angularMomentumLoss(settings);
            row.losses.push_back(loss ? std::optional(*loss) : std::nullopt);
            Report one{{"name", fmt::format("{}, {} substeps", method.name, count)}};
            one["percent"] = loss ? Report(100 * loss->lost) : Report();
            one["backward_euler_percent"] = loss ? Report(100 * loss->predicted) : Report();
            one["rate"] = loss ? Report(loss->rate) : Report();
            report.push_back(std::move(one));
        }
        rows.push_back(std::move(row));
        if (options.progress) options.progress("free strands", rows.size(), all.size());
    }
    return Outcome{Report{{"name", "momentum"}, {"rows", std::move(report)}},
                   {},
                   {{"momentum.md", markdownOf(substeps, rows, options.commandLine)},
                    {"momentum.svg", figureOf(substeps, rows)}}};
}

}  // namespace

Benchmark momentumBenchmark() {
    return {"momentum", "loss of angular momentum of free strands", {"--quick", "--output"}, runMomentum};
}

}  // namespace hairloom::benchmarks
