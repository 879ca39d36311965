// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "cli/job.h"
#include "importers/child_process.h"

namespace hairloom::cli {
namespace {

struct BenchOptions {
    std::string name;
    int repetitions = 5;
};

/// Real times of the repetitions of each measurement, in the order in which they ran.
struct Measurement {
    std::string name;
    std::string unit;
    std::vector<double> times;
};

std::vector<Measurement> measurementsOf(const nlohmann::json& result) {
    std::vector<Measurement> measurements;
    std::map<std::string, std::size_t> places;
    for (const auto& run : result.at("benchmarks")) {
        if (run.at("run_type") != "iteration" || run.contains("error_occurred")) continue;
        const auto name = run.at("name").get<std::string>();
        const auto [place, isNew] = places.try_emplace(name, measurements.size());
        if (isNew) measurements.push_back({name, run.at("time_unit").get<std::string>(), {}});
        measurements[place->second].times.push_back(run.at("real_time").get<double>());
    }
    return measurements;
}

Report rowOf(Measurement measurement) {
    std::vector<double>& times = measurement.times;
    std::sort(times.begin(), times.end());
    const std::size_t middle = times.size() / 2;
    const double median = times.size() % 2 == 1 ? times[middle] : 0.5 * (times[middle - 1] + times[middle]);
    return Report{{"name", measurement.name}, {"n", times.size()},   {"median", median},
                  {"min", times.front()},     {"max", times.back()}, {"unit", measurement.unit}};
}

Result<Report> bench(const BenchOptions& options) {
    ChildLimits limits;
    limits.time = std::chrono::hours(1);
    limits.residentBytes = std::uint64_t{16} << 30u;
    const auto output = runChild(
        "the benchmark", programFolder() / ("bench_" + options.name),
        {"--benchmark_format=json", fmt::format("--benchmark_repetitions={}", options.repetitions)}, limits);
    if (!output) return tl::unexpected(output.error());
    const char* const text = reinterpret_cast<const char*>(output->data());
    const auto result = nlohmann::json::parse(text, text + output->size(), nullptr, false);
    if (result.is_discarded())
        return fail("the benchmark wrote no JSON", "expected Google Benchmark's format");
    Report rows = Report::array();
    for (Measurement& measurement : measurementsOf(result)) rows.push_back(rowOf(std::move(measurement)));
    return Report{{"name", options.name}, {"rows", std::move(rows)}};
}

}  // namespace

void addBenchJob(Jobs& jobs) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App& job = jobs.add("bench", "Measure a part of Hairloom on this machine; medians of repeated runs",
                             "place --json", [options] { return bench(*options); });
    job.add_option("name", options->name, "What to measure")
        ->required()
        ->check(CLI::IsMember({"interpolate", "io", "place", "project", "render", "sim"}));
    job.add_option("--repetitions", options->repetitions, "Runs of each measurement")
        ->check(CLI::Range(1, 1000));
}

}  // namespace hairloom::cli
