// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/accuracy/statistics.h"
#include "importers/child_process.h"

namespace hairloom::cli {
namespace {

/// Google Benchmark writes statistics that are no numbers, such as the variation of a counter that stays 0,
/// as bare NaN and Infinity, which JSON does not have; here they are null.
std::string withoutBareWords(std::string_view text) {
    constexpr std::string_view kWords[] = {"NaN", "-NaN", "Infinity", "-Infinity"};
    std::string json;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size();) {
        if (quoted && text[i] == '\\') {
            json += text.substr(i, 2);
            i += 2;
            continue;
        }
        if (text[i] == '"') quoted = !quoted;
        const std::string_view rest = text.substr(i);
        const auto* const word = std::ranges::find_if(
            kWords, [&](std::string_view candidate) { return !quoted && rest.starts_with(candidate); });
        if (word == std::end(kWords)) {
            json += text[i++];
        } else {
            json += "null";
            i += word->size();
        }
    }
    return json;
}

}  // namespace

Result<std::vector<Measurement>> measurementsOf(std::string_view benchmarkJson) {
    const auto result = nlohmann::json::parse(withoutBareWords(benchmarkJson), nullptr, false);
    const auto benchmarks = result.is_object() ? result.find("benchmarks") : result.end();
    if (benchmarks == result.end())
        return fail("the benchmark wrote no JSON", "expected Google Benchmark's format");
    std::vector<Measurement> measurements;
    std::map<std::string, std::size_t> places;
    for (const auto& run : *benchmarks) {
        if (run.at("run_type") != "iteration" || run.contains("error_occurred")) continue;
        const auto name = run.at("name").get<std::string>();
        const auto [place, isNew] = places.try_emplace(name, measurements.size());
        if (isNew) measurements.push_back({name, run.at("time_unit").get<std::string>(), {}});
        measurements[place->second].values.push_back(run.at("real_time").get<double>());
    }
    return measurements;
}

double Measurement::median() const {
    return quartiles(values).median;
}

Report rowOf(const Measurement& measurement) {
    const auto [minimum, maximum] = std::ranges::minmax(measurement.values);
    return Report{{"name", measurement.name},
                  {"n", measurement.values.size()},
                  {"median", measurement.median()},
                  {"min", minimum},
                  {"max", maximum},
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
    return measurementsOf(std::string_view(text, output->size()));
}

}  // namespace hairloom::cli
