// SPDX-License-Identifier: GPL-3.0-or-later
// What `bench gpu-sim` measured, as JSON, CSV, Markdown and a chart.
#include <fmt/format.h>

#include <iterator>

#include "benchmarks/gpu_sim.h"
#include "core/charts/plot.h"

namespace hairloom::benchmarks {
namespace {

Report orNull(const std::optional<double>& value) {
    return value ? Report(*value) : Report();
}

std::string orNothing(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : std::string();
}

std::string orDash(const std::optional<double>& value, const char* unit) {
    return value ? fmt::format("{:.3g}{}", *value, unit) : "–";
}

Report rowReport(const GpuBenchRow& row) {
    return Report{{"hair", row.hair},
                  {"strands", row.strands},
                  {"points", row.points},
                  {"substeps", row.substeps},
                  {"left_out", row.leftOut},
                  {"layout", row.layout},
                  {"gpu_ms", row.gpu.device},
                  {"gpu_wall_ms", row.gpu.wall},
                  {"gpu_together_ms", row.gpu.together},
                  {"cpu_one_thread_ms", orNull(row.cpuOne)},
                  {"cpu_all_threads_ms", orNull(row.cpuAll)},
                  {"bytes_per_particle_substep", row.bytes},
                  {"gb_per_s", row.bandwidth}};
}

Report rowsReport(const std::vector<GpuBenchRow>& rows) {
    Report report = Report::array();
    for (const GpuBenchRow& row : rows) report.push_back(rowReport(row));
    return report;
}

using Out = std::back_insert_iterator<std::string>;

void csvRows(const std::vector<GpuBenchRow>& rows, const char* table, Out out) {
    for (const GpuBenchRow& row : rows) {
        fmt::format_to(out, "{},{},{},{},{},{},\"{}\",{:.6g},{:.6g},{:.6g},{},{},{:.6g},{:.6g}\n", table,
                       row.hair, row.strands, row.points, row.substeps, row.leftOut, row.layout,
                       row.gpu.device, row.gpu.wall, row.gpu.together, orNothing(row.cpuOne),
                       orNothing(row.cpuAll), row.bytes, row.bandwidth);
    }
}

void effectRows(const GpuBench& bench, Out out) {
    fmt::format_to(out,
                   "\n## What each effect costs\n\nThe frame with every effect minus the frame without it, "
                   "in ms on the device.\n\n| strands | frame | wind | collision | angular | length | "
                   "damping |\n|---|---|---|---|---|---|---|\n");
    double whole = 0.0;
    for (const GpuBenchRow& row : bench.effects) {
        if (row.leftOut == "nothing") {
            whole = row.gpu.device;
            fmt::format_to(out, "| {} | {:.3g} ", row.strands, whole);
            continue;
        }
        fmt::format_to(out, "| {:.3g} ", whole - row.gpu.device);
        if (row.leftOut == leftOutName(LeftOut::damping)) fmt::format_to(out, "|\n");
    }
}

Series seriesOf(const char* name, const std::vector<GpuBenchRow>& rows, Marker marker,
                std::optional<double> (*value)(const GpuBenchRow&)) {
    Series series;
    series.name = name;
    series.marker = marker;
    series.line = LineStyle::Solid;
    for (const GpuBenchRow& row : rows) {
        if (const auto milliseconds = value(row))
            series.points.push_back({static_cast<double>(row.strands), *milliseconds});
    }
    return series;
}

}  // namespace

Report reportOf(const GpuBench& bench) {
    return Report{{"name", "gpu-sim"},
                  {"device", bench.device},
                  {"driver", bench.driver},
                  {"date", bench.date},
                  {"processor", bench.machine.processor},
                  {"threads", bench.machine.threads},
                  {"copy_gb_per_s", bench.copyBandwidth},
                  {"crosses_one_thread", orNull(bench.crossesOne)},
                  {"crosses_all_threads", orNull(bench.crossesAll)},
                  {"samples", rowsReport(bench.samples)},
                  {"rows", rowsReport(bench.rows)},
                  {"effects", rowsReport(bench.effects)},
                  {"layouts", rowsReport(bench.layouts)},
                  {"backward_euler", rowsReport(bench.backward)}};
}

std::string csvOf(const GpuBench& bench) {
    std::string text;
    const Out out = std::back_inserter(text);
    fmt::format_to(out, "# device: {}; driver: {}; date: {}; processor: {}; threads: {}; copy: {:.0f} GB/s\n",
                   bench.device, bench.driver, bench.date, bench.machine.processor, bench.machine.threads,
                   bench.copyBandwidth);
    fmt::format_to(out,
                   "table,hair,strands,points,substeps,left_out,layout,gpu_ms,gpu_wall_ms,gpu_together_ms,"
                   "cpu_one_thread_ms,cpu_all_threads_ms,bytes_per_particle_substep,gb_per_s\n");
    csvRows(bench.samples, "samples", out);
    csvRows(bench.rows, "figure", out);
    csvRows(bench.effects, "effects", out);
    csvRows(bench.layouts, "layouts", out);
    csvRows(bench.backward, "backward_euler", out);
    return text;
}

std::string markdownOf(const GpuBench& bench, const std::string& command) {
    std::string text;
    const Out out = std::back_inserter(text);
    fmt::format_to(
        out,
        "# Measured on a GPU\n\nWritten by `{}` on {}. docs/gpu-simulation.md says what is measured.\n\n"
        "Device: {}, driver {}; it copies {:.0f} GB/s (read and written). Processor: {}, {} threads.\n\n"
        "Strands of 16 points with the default settings, every effect, ten spheres; ms per frame. The GPU's "
        "wall "
        "clock passes below one thread at {} strands, below all threads at {}.\n\n"
        "| strands | GPU | GPU, wall | GPU, frames together | CPU, one thread | CPU, all threads | "
        "bytes a particle and substep | share of the copy's bandwidth |\n|---|---|---|---|---|---|---|---|\n",
        command, bench.date, bench.device, bench.driver, bench.copyBandwidth, bench.machine.processor,
        bench.machine.threads, orDash(bench.crossesOne, ""), orDash(bench.crossesAll, ""));
    for (const GpuBenchRow& row : bench.rows) {
        fmt::format_to(out, "| {} | {:.3g} | {:.3g} | {:.3g} | {} | {} | {:.1f} | {:.1f} % |\n", row.strands,
                       row.gpu.device, row.gpu.wall, row.gpu.together, orDash(row.cpuOne, ""),
                       orDash(row.cpuAll, ""), row.bytes, 100.0 * row.bandwidth / bench.copyBandwidth);
    }
    fmt::format_to(out,
                   "\n## The samples\n\nOn a nodding head, with their own settings, in ms per frame.\n\n| "
                   "sample | strands | points | substeps | GPU | GPU, wall | CPU, one thread | CPU, all "
                   "threads |\n|---|---|---|---|---|---|---|---|\n");
    for (const GpuBenchRow& row : bench.samples) {
        fmt::format_to(out, "| {} | {} | {} | {} | {:.3g} | {:.3g} | {} | {} |\n", row.hair, row.strands,
                       row.points, row.substeps, row.gpu.device, row.gpu.wall, orDash(row.cpuOne, ""),
                       orDash(row.cpuAll, ""));
    }
    effectRows(bench, out);
    fmt::format_to(out, "\n## Layouts\n\n| strands | model | layout | GPU, ms |\n|---|---|---|---|\n");
    for (const GpuBenchRow& row : bench.layouts)
        fmt::format_to(out, "| {} | {} | {} | {:.3g} |\n", row.strands, row.hair, row.layout, row.gpu.device);
    fmt::format_to(out,
                   "\n## Backward Euler\n\nSprings with the default settings and this integrator, in ms per "
                   "frame.\n\n| strands | model | GPU | GPU, wall | CPU, one thread | CPU, all threads |\n"
                   "|---|---|---|---|---|---|\n");
    for (const GpuBenchRow& row : bench.backward) {
        fmt::format_to(out, "| {} | {} | {:.3g} | {:.3g} | {} | {} |\n", row.strands, row.hair,
                       row.gpu.device, row.gpu.wall, orDash(row.cpuOne, ""), orDash(row.cpuAll, ""));
    }
    return text;
}

std::string figureOf(const GpuBench& bench) {
    Plot plot;
    plot.title = "A frame of simulation against the number of guides";
    plot.note = fmt::format("16 points, default settings, every effect, ten spheres. {}; {}, {} threads; {}",
                            bench.device, bench.machine.processor, bench.machine.threads, bench.date);
    plot.x = {.title = "guides", .scale = Scale::Logarithmic};
    plot.y = {.title = "time", .unit = "ms", .scale = Scale::Logarithmic};
    plot.series.push_back(seriesOf("CPU, one thread", bench.rows, Marker::Square,
                                   [](const GpuBenchRow& row) { return row.cpuOne; }));
    plot.series.push_back(seriesOf("CPU, all threads", bench.rows, Marker::Diamond,
                                   [](const GpuBenchRow& row) { return row.cpuAll; }));
    plot.series.push_back(seriesOf("GPU, wall clock", bench.rows, Marker::Circle,
                                   [](const GpuBenchRow& row) { return std::optional(row.gpu.wall); }));
    plot.series.push_back(seriesOf("GPU, on the device", bench.rows, Marker::TriangleUp,
                                   [](const GpuBenchRow& row) { return std::optional(row.gpu.device); }));
    return svg(plot);
}

}  // namespace hairloom::benchmarks
