// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "cli/job.h"
#include "cli/measurements.h"
#include "cli/simulation_bench.h"
#include "core/base/file.h"

namespace hairloom::cli {
namespace {

struct BenchOptions {
    std::string name;
    int repetitions = 5;
    std::vector<std::uint32_t> strands;
    bool quick = false;
    std::string markdown;
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

Result<Report> bench(const BenchOptions& options, const std::string& command) {
    if (options.name == "sim") return benchSimulation(options, command);
    if (options.quick || !options.strands.empty() || !options.markdown.empty())
        return fail("--strands, --quick and --markdown are of `bench sim`");
    const auto measured = runBenchmarkProgram(options.name, options.repetitions);
    if (!measured) return tl::unexpected(measured.error());
    Report rows = Report::array();
    for (const Measurement& measurement : *measured) rows.push_back(rowOf(measurement));
    return Report{{"name", options.name}, {"rows", std::move(rows)}};
}

}  // namespace

void addBenchJob(Jobs& jobs) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App& job =
        jobs.add("bench", "Measure a part of Hairloom on this machine; medians of repeated runs",
                 "sim --quick --json", [options, &jobs] { return bench(*options, jobs.commandLine()); });
    job.add_option("name", options->name, "What to measure")
        ->required()
        ->check(CLI::IsMember({"brush", "interpolate", "io", "place", "project", "render", "sim"}));
    job.add_option("--repeat,--repetitions", options->repetitions, "Runs of each measurement")
        ->check(CLI::Range(1, 1000));
    job.add_option("--strands", options->strands, "sim: numbers of strands, instead of 300,2000,10000,100000")
        ->delimiter(',')
        ->check(CLI::Range(1, 1'000'000));
    job.add_flag("--quick", options->quick, "sim: shorter runs of fewer strands, to see that it works");
    job.add_option("--markdown", options->markdown, "sim: file to write the tables to");
}

}  // namespace hairloom::cli
