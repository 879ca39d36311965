// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/accuracy/statistics.h"
#include "importers/child_process.h"

namespace hairloom::cli {
namespace {

std::vector<Measurement> measurementsOf(const nlohmann::json& result) {
    std::vector<Measurement> measurements;
    std::map<std::string, std::size_t> places;
    for (const auto& run : result.at("benchmarks")) {
        if (run.at("run_type") != "iteration" || run.contains("error_occurred")) continue;
        const auto name = run.at("name").get<std::string>();
        const auto [place, isNew] = places.try_emplace(name, measurements.size());
        if (isNew) measurements.push_back({name, run.at("time_unit").get<std::string>(), {}});
        measurements[place->second].values.push_back(run.at("real_time").get<double>());
    }
    return measurements;
}

}  // namespace

double Measurement::median() const {
    return quartiles(values).median;
}

Report rowOf(const Measurement& measurement) {
    const auto [least, most] = std::ranges::minmax(measurement.values);
    return Report{{"name", measurement.name},
                  {"n", measurement.values.size()},
                  {"median", measurement.median()},
                  {"min", least},
                  {"max", most},
                  {"unit", measurement.unit}};
}

Result<std::vector<Measurement>> runBenchmarkProgram(const std::string& name, int repetitions,
                                                     const std::vector<std::string>& arguments) {
    ChildLimits limits;
    limits.time = std::chrono::hours(1);
    limits.residentBytes = std::uint64_t{16} << 30u;
    std::vector<std::string> all{"--benchmark_format=json",
                                 fmt::format("--benchmark_repetitions={}", repetitions)};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto output = runChild("the benchmark", programFolder() / ("bench_" + name), all, limits);
    if (!output) return tl::unexpected(output.error());
    const char* const text = reinterpret_cast<const char*>(output->data());
    const auto result = nlohmann::json::parse(text, text + output->size(), nullptr, false);
    if (result.is_discarded())
        return fail("the benchmark wrote no JSON", "expected Google Benchmark's format");
    return measurementsOf(result);
}

}  // namespace hairloom::cli
