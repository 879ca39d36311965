// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/accuracy/work_precision_report.h"
#include "hairloom/settings.h"

namespace hairloom {
namespace {

constexpr Marker kShapes[] = {Marker::Circle, Marker::Square, Marker::TriangleUp, Marker::Diamond};
constexpr const char* kGrey = "#666666";

bool varies(const std::vector<GridAxis>& axes, std::size_t axis) {
    return axes[axis].values.size() > 1;
}

/// Place of the run's value among its axis's; 0 where there is no such axis.
std::size_t placeOf(const WorkPrecision& result, const WorkPrecisionRun& run,
                    std::optional<std::size_t> axis) {
    if (!axis) return 0;
    const auto& values = result.options.axes[*axis].values;
    return static_cast<std::size_t>(std::ranges::find(values, run.values[*axis]) - values.begin());
}

/// The axis whose values have colours: the first enumeration that varies, or else the first there is.
std::optional<std::size_t> colouredAxis(const std::vector<GridAxis>& axes) {
    std::optional<std::size_t> first;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (!isEnumeration(axes[a].field)) continue;
        if (varies(axes, a)) return a;
        if (!first) first = a;
    }
    return first;
}

/// Axes whose values stand in labels: those that vary, but for the one that has colours.
std::vector<std::size_t> labelledAxes(const std::vector<GridAxis>& axes) {
    const auto coloured = colouredAxis(axes);
    std::vector<std::size_t> labelled;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (varies(axes, a) && a != coloured) labelled.push_back(a);
    }
    return labelled;
}

std::string shortLabel(const WorkPrecision& result, const WorkPrecisionRun& run) {
    std::string label;
    for (const std::size_t a : labelledAxes(result.options.axes)) {
        label += fmt::format("{}{}", label.empty() ? "" : "/",
                             axisValueText(result.options.axes[a], run.values[a]));
    }
    return label;
}

std::string noteUnderPlot(const WorkPrecision& result, const ReportContext& context) {
    std::string labels;
    for (const std::size_t a : labelledAxes(result.options.axes)) {
        labels += fmt::format("{}{}", labels.empty() ? "Labels: " : " / ", result.options.axes[a].field);
    }
    return fmt::format(
        "{}{}{} of {} strands, {} frames at {:g} Hz, motion {}. Bars: quartiles of {} runs. Error "
        "against {}.",
        labels, labels.empty() ? "" : ". ", result.strands, result.groomStrands, result.options.time.frames,
        result.options.time.framesPerSecond, context.motion, result.options.repeats, result.groundTruthName);
}

std::string tooltipOf(const WorkPrecision& result, const WorkPrecisionRun& run,
                      Measure measure = Measure::distance) {
    const std::string of =
        measure == Measure::distance
            ? fmt::format("{:.4g} mm rms, {:.4g} mm at most", run.error.rmsMm, run.error.maxMm)
            : fmt::format("{:.4g} {}", valueOf(run, measure), infoOf(measure).unit);
    return fmt::format("{}: {:.4g} ms, {}", settingText(result, run), run.milliseconds.median, of);
}

/// " (3 of 36 diverged)" of the runs with one value of an axis, empty where none did: they have no place.
std::string divergedText(const WorkPrecision& result, std::size_t axis, double value) {
    std::size_t runs = 0, diverged = 0;
    for (const WorkPrecisionRun& run : result.runs) {
        if (run.values[axis] != value) continue;
        ++runs;
        diverged += run.diverged;
    }
    return diverged > 0 ? fmt::format(" ({} of {} diverged)", diverged, runs) : std::string();
}

/// Series that only name the colours and the shapes.
void addLegend(const WorkPrecision& result, std::optional<std::size_t> coloured,
               std::optional<std::size_t> points, Plot& plot) {
    if (coloured) {
        const GridAxis& axis = result.options.axes[*coloured];
        for (std::size_t v = 0; v < axis.values.size(); ++v) {
            plot.series.push_back({.name = axisValueText(axis, axis.values[v]) +
                                           divergedText(result, *coloured, axis.values[v]),
                                   .colour = paletteColour(v)});
        }
    }
    if (points && varies(result.options.axes, *points)) {
        const GridAxis& axis = result.options.axes[*points];
        for (std::size_t v = 0; v < axis.values.size(); ++v) {
            plot.series.push_back(
                {.name = fmt::format("{} {}", axisValueText(axis, axis.values[v]), axis.field),
                 .colour = kGrey,
                 .marker = kShapes[v % std::size(kShapes)]});
        }
    }
}

struct TimeRange {
    double low = std::numeric_limits<double>::infinity(), high = 0;
};

/// How far the truth can be trusted, as a line across.
void addUncertainty(double uncertaintyMm, double from, double to, Plot& plot) {
    if (!(uncertaintyMm > 0) || !(from < to)) return;
    plot.series.push_back({.name = "uncertainty of the reference",
                           .points = {{from, uncertaintyMm}, {to, uncertaintyMm}},
                           .colour = "#999999",
                           .marker = Marker::None,
                           .line = LineStyle::Dashed});
}

/// The value of an axis that error plots of another one hold: its largest, the first of choices.
double heldValue(const GridAxis& axis) {
    const auto* field = runtime::findField<runtime::SimulationSettings>(axis.field);
    if (field && !field->choices.empty()) return axis.values.front();
    return *std::ranges::max_element(axis.values);
}

}  // namespace

std::string settingText(const WorkPrecision& result, const WorkPrecisionRun& run) {
    std::string text;
    for (std::size_t a = 0; a < run.values.size(); ++a) {
        const GridAxis& axis = result.options.axes[a];
        text += fmt::format("{}{} {}", a == 0 ? "" : ", ", axis.field, axisValueText(axis, run.values[a]));
    }
    return text;
}

Plot workPrecisionPlot(const WorkPrecision& result, const ReportContext& context, Measure measure) {
    const MeasureInfo& judged = infoOf(measure);
    const bool isDistance = measure == Measure::distance;
    Plot plot;
    plot.title = isDistance ? "Work and precision: time per frame against error"
                            : fmt::format("Time per frame against {}", judged.label);
    plot.note = isDistance ? noteUnderPlot(result, context)
                           : fmt::format("{} {:g} {} and less at the lower edge.", judged.meaning,
                                         judged.floor, judged.unit);
    plot.x = {.title = "time per frame", .unit = "ms", .scale = Scale::Logarithmic};
    plot.y = {.title = judged.label, .unit = judged.unit, .scale = Scale::Logarithmic};
    plot.width = 860;
    plot.height = 560;
    const auto coloured = colouredAxis(result.options.axes);
    const auto points = findAxis(result.options.axes, kPointsAxis);
    addLegend(result, coloured, points, plot);

    std::map<std::pair<std::size_t, std::size_t>, Series> series;
    std::vector<PlotPoint> front;
    TimeRange times;
    const std::vector<bool> best = frontBy(result, measure);
    for (std::size_t r = 0; r < result.runs.size(); ++r) {
        const WorkPrecisionRun& run = result.runs[r];
        if (run.diverged) continue;
        const double value = std::max(valueOf(run, measure), judged.floor);
        const auto key = std::pair(placeOf(result, run, coloured), placeOf(result, run, points));
        series[key].points.push_back({.x = run.milliseconds.median,
                                      .y = value,
                                      .xLow = run.milliseconds.q1,
                                      .xHigh = run.milliseconds.q3,
                                      .label = best[r] ? shortLabel(result, run) : std::string(),
                                      .tooltip = tooltipOf(result, run, measure),
                                      .faint = !best[r]});
        if (best[r]) front.push_back({run.milliseconds.median, value});
        times.low = std::min(times.low, run.milliseconds.q1);
        times.high = std::max(times.high, run.milliseconds.q3);
    }
    std::ranges::sort(front, {}, &PlotPoint::x);
    plot.series.push_back({.name = "Pareto front",
                           .points = std::move(front),
                           .colour = kGrey,
                           .marker = Marker::None,
                           .line = LineStyle::Solid});
    if (isDistance) addUncertainty(result.groundTruthUncertaintyMm, times.low, times.high, plot);
    for (auto& [key, one] : series) {
        one.colour = paletteColour(key.first);
        one.marker = kShapes[key.second % std::size(kShapes)];
        plot.series.push_back(std::move(one));
    }
    return plot;
}

std::optional<Plot> partsPlot(const WorkPrecision& result) {
    std::vector<const WorkPrecisionRun*> runs;
    for (const WorkPrecisionRun& run : result.runs) {
        if (run.parts) runs.push_back(&run);
    }
    if (runs.empty()) return std::nullopt;
    std::ranges::sort(runs, {}, [](const WorkPrecisionRun* run) { return run->milliseconds.median; });
    Plot plot;
    plot.title = "Sources of error";
    plot.note = fmt::format(
        "Steps: difference from the same setting with up to {} substeps. Points: difference from twice the "
        "finest strands. Model: difference between the elastic rod and the finest strands of this model, "
        "with short steps. Each is measured separately, so they need not add up. Sorted from fastest to most "
        "accurate.",
        kConvergedSubsteps);
    std::vector<std::size_t> named;
    std::string names;
    for (std::size_t a = 0; a < result.options.axes.size(); ++a) {
        if (!varies(result.options.axes, a)) continue;
        named.push_back(a);
        names += (names.empty() ? "" : " / ") + result.options.axes[a].field;
    }
    if (!names.empty()) plot.note = fmt::format("Labels: {}. {}", names, plot.note);
    plot.bars = true;
    plot.width = 860;
    plot.x = {.title = "setting", .low = -0.5, .high = static_cast<double>(runs.size()) - 0.5};
    plot.y = {.title = "root mean square", .unit = "mm", .scale = Scale::Logarithmic};
    plot.series = {{.name = "steps"}, {.name = "points"}, {.name = "model"}, {.name = "uncertainty"}};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < runs.size(); ++r) {
        const ErrorParts& parts = *runs[r]->parts;
        std::string label;
        for (const std::size_t a : named)
            label += (label.empty() ? "" : "/") + axisValueText(result.options.axes[a], runs[r]->values[a]);
        plot.x.ticks.push_back({static_cast<double>(r), label.empty() ? "current" : label});
        const double mm[] = {parts.step.rmsMm, parts.points.rmsMm, parts.model.rmsMm,
                             result.groundTruthUncertaintyMm};
        for (std::size_t s = 0; s < plot.series.size(); ++s) {
            if (mm[s] > 0) least = std::min(least, mm[s]);
            plot.series[s].points.push_back(
                {.x = static_cast<double>(r),
                 .y = mm[s],
                 .tooltip = fmt::format("{}: {} {:.3g} mm", settingText(result, *runs[r]),
                                        plot.series[s].name, mm[s])});
        }
    }
    if (std::isfinite(least)) plot.y.low = least / 3;
    return plot;
}

std::optional<Plot> errorPlot(const WorkPrecision& result, std::size_t axisIndex) {
    const std::vector<GridAxis>& axes = result.options.axes;
    const GridAxis& axis = axes[axisIndex];
    const auto* field = runtime::findField<runtime::SimulationSettings>(axis.field);
    const bool ofNumbers = !isEnumeration(axis.field) && axis.field != kThreadsAxis &&
                           axis.field != kHairVolumeAxis && axis.field != kHairsPerGuideAxis;
    if (!ofNumbers || !varies(axes, axisIndex)) return std::nullopt;

    const auto coloured = colouredAxis(axes);
    std::string held;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (a == axisIndex || a == coloured || axes[a].field == kThreadsAxis) continue;
        held += fmt::format("{}{} {}", held.empty() ? "Held: " : ", ", axes[a].field,
                            axisValueText(axes[a], heldValue(axes[a])));
    }
    std::vector<double> sorted = axis.values;
    std::ranges::sort(sorted);
    Plot plot;
    plot.title = "Error against " + axis.field;
    plot.note = held.empty() ? "" : held + ".";
    plot.infinityName = "diverged";
    const bool logarithmic = sorted.front() > 0 && sorted.back() >= 4 * sorted.front();
    plot.x = {.title = axis.field,
              .unit = field ? field->unit : "",
              .scale = logarithmic ? Scale::Logarithmic : Scale::Linear,
              .ticks = ticksAt(sorted)};
    plot.y = {.title = "error, root mean square", .unit = "mm", .scale = Scale::Logarithmic};

    std::map<std::size_t, Series> series;
    for (const WorkPrecisionRun& run : result.runs) {
        bool shown = true;
        for (std::size_t a = 0; a < axes.size(); ++a) {
            const bool free = a == axisIndex || a == coloured;
            const double wanted = axes[a].field == kThreadsAxis ? axes[a].values.front() : heldValue(axes[a]);
            shown = shown && (free || run.values[a] == wanted);
        }
        if (!shown) continue;
        const double error = run.diverged ? std::numeric_limits<double>::infinity() : run.error.rmsMm;
        series[placeOf(result, run, coloured)].points.push_back(
            {.x = run.values[axisIndex], .y = error, .tooltip = tooltipOf(result, run)});
    }
    for (auto& [place, one] : series) {
        if (coloured) one.name = axisValueText(axes[*coloured], axes[*coloured].values[place]);
        one.colour = paletteColour(place);
        one.line = LineStyle::Solid;
        std::ranges::sort(one.points, {}, &PlotPoint::x);
        plot.series.push_back(std::move(one));
    }
    addUncertainty(result.groundTruthUncertaintyMm, sorted.front(), sorted.back(), plot);
    return plot;
}

}  // namespace hairloom
