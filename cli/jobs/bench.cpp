// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "cli/gpu_bench.h"
#include "cli/job.h"
#include "cli/measurements.h"
#include "cli/render_bench.h"
#include "cli/shadow_bench.h"
#include "cli/simulation_bench.h"
#include "cli/vectors.h"
#include "core/base/file.h"

namespace hairloom::cli {
namespace {

struct BenchOptions {
    RenderBenchOptions render;
    std::uint32_t device = 0;
    std::string size;
    bool repetitionsGiven = false;
    std::string name;
    int repetitions = 5;
    std::vector<std::uint32_t> strands;
    bool quick = false;
    std::string markdown;
    std::string output;
    bool deviceGiven = false;
};

Result<Report> benchSimulation(const BenchOptions& options, const std::string& command) {
    SimulationBenchOptions wanted;
    wanted.repetitions = options.repetitions;
    if (options.quick) {
        wanted.strands = {300, 2'000};
        wanted.seconds = 0.02;
    }
    if (!options.strands.empty()) wanted.strands = options.strands;
    const SimulationBench bench = runSimulationBench(wanted);
    Report report = reportOf(bench);
    if (!options.markdown.empty()) {
        if (auto written = writeFileAtomically(options.markdown, markdownOf(bench, command)); !written)
            return tl::unexpected(written.error());
        report["output"] = options.markdown;
    }
    return report;
}

Result<Report> benchGpuSimulation(const BenchOptions& options, const std::string& command) {
    GpuBenchOptions wanted;
    if (options.deviceGiven) wanted.device = options.device;
    if (options.quick) {
        wanted.strands = {100, 300};
        wanted.details = {100};
        wanted.seconds = 0.02;
    }
    if (!options.strands.empty()) {
        wanted.strands = options.strands;
        wanted.details = {options.strands.back()};
    }
    const auto bench = runGpuBench(wanted);
    if (!bench) return tl::unexpected(bench.error());
    Report report = reportOf(*bench);
    if (options.output.empty()) return report;
    const auto written = writeFiles(options.output, {{"gpu-sim.csv", csvOf(*bench)},
                                                     {"gpu-sim.md", markdownOf(*bench, command)},
                                                     {"figure-27.svg", figureOf(*bench)}});
    if (!written) return tl::unexpected(written.error());
    report["output"] = *written;
    return report;
}

Result<Report> benchRendering(const BenchOptions& options, const std::string& command) {
    RenderBenchOptions wanted = options.render;
    if (options.repetitionsGiven) wanted.repetitions = options.repetitions;
    if (!options.size.empty()) {
        const auto size = parseSize(options.size);
        if (!size) return tl::unexpected(size.error());
        wanted.size = *size;
    }
    const auto bench = runRenderBench(wanted);
    if (!bench) return tl::unexpected(bench.error());
    Report report = reportOf(*bench);
    if (options.markdown.empty()) return report;
    if (auto written = writeFileAtomically(options.markdown, markdownOf(*bench, command)); !written) {
        return tl::unexpected(written.error());
    }
    report["output"] = options.markdown;
    return report;
}

Result<Report> benchShadows(const BenchOptions& options, const std::string& command) {
    ShadowBenchOptions wanted;
    wanted.quick = options.quick;
    if (options.deviceGiven) wanted.device = options.device;
    const auto bench = runShadowBench(wanted);
    if (!bench) return tl::unexpected(bench.error());
    Report report = reportOf(*bench);
    if (options.output.empty()) return report;
    const auto written = writeFiles(
        options.output, {{"shadows.md", markdownOf(*bench, command)}, {"shadows.svg", figureOf(*bench)}});
    if (!written) return tl::unexpected(written.error());
    report["output"] = *written;
    return report;
}

Result<Report> bench(const BenchOptions& options, const std::string& command) {
    if (options.name == "sim") return benchSimulation(options, command);
    if (options.name == "gpu-sim") return benchGpuSimulation(options, command);
    if (options.name == "render") return benchRendering(options, command);
    if (options.name == "shadows") return benchShadows(options, command);
    if (options.quick || !options.strands.empty() || !options.markdown.empty())
        return fail(
            "--strands and --quick are of `bench sim` and `bench gpu-sim`, --markdown of `bench sim` and "
            "`bench "
            "render`");
    const auto measured = runBenchmarkProgram(options.name, options.repetitions);
    if (!measured) return tl::unexpected(measured.error());
    Report rows = Report::array();
    for (const Measurement& measurement : *measured) rows.push_back(rowOf(measurement));
    return Report{{"name", options.name}, {"rows", std::move(rows)}};
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<BenchOptions>();
    job.add_option("name", options->name, "What to measure")
        ->required()
        ->check(CLI::IsMember({"brush", "gpu-sim", "interpolate", "io", "material", "place", "project",
                               "render", "shading", "shadows", "sim", "window"}));
    auto* const repetitions =
        job.add_option("--repeat,--repetitions", options->repetitions, "Runs of each measurement")
            ->check(CLI::Range(1, 1000));
    job.add_option("--strands", options->strands,
                   "sim, gpu-sim: numbers of strands, instead of the usual ones, ascending")
        ->delimiter(',')
        ->check(CLI::Range(1, 1'000'000));
    job.add_flag("--quick", options->quick,
                 "sim, gpu-sim, shadows: shorter runs of fewer strands, to see that it works");
    job.add_option("--markdown", options->markdown, "sim, render: file to write the tables to");
    job.add_option("--hairs", options->render.hairs,
                   "render: numbers of hairs, instead of 3100,9300,18300,100000")
        ->delimiter(',')
        ->check(CLI::Range(1, 1'000'000));
    job.add_option("--size", options->size, "render: pixels WxH of all pictures");
    job.add_option("-o,--output", options->output,
                   "gpu-sim, shadows: folder to write the table, its Markdown and the chart to");
    auto* const device = job.add_option("--device", options->device,
                                        "gpu-sim, render, shadows: GPU to use, by its index in `devices`");
    job.final_callback([options, repetitions, device] {
        options->repetitionsGiven = repetitions->count() > 0;
        options->deviceGiven = device->count() > 0;
        if (options->deviceGiven) options->render.device = options->device;
    });
    return [options](const std::string& commandLine) { return bench(*options, commandLine); };
}

}  // namespace

Job benchJob() {
    return {"bench", "Measure a part of Hairloom on this machine; medians of repeated runs",
            "sim --quick --json", declare};
}

}  // namespace hairloom::cli
