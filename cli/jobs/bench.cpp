// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "benchmarks/benchmark.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/vectors.h"
#include "core/base/file.h"

namespace hairloom::cli {
namespace {

using benchmarks::Benchmark;

struct BenchOptions {
    std::string name;
    int repetitions = 0;
    std::uint32_t device = 0;
    std::string size;
    std::string markdown;
    std::string output;
    std::vector<std::string> given;  ///< options that only some benchmarks take
    benchmarks::Options measuring;
};

const Benchmark& benchmarkOf(const std::string& name) {
    return *std::ranges::find(benchmarks::benchmarks(), name, &Benchmark::name);
}

/// "sim, render"
std::string whoTakes(const std::string& option) {
    std::string names;
    for (const Benchmark& benchmark : benchmarks::benchmarks()) {
        if (std::ranges::find(benchmark.takes, option) == benchmark.takes.end()) continue;
        names += (names.empty() ? "" : ", ") + benchmark.name;
    }
    return names;
}

void checkOptions(const BenchOptions& options) {
    const Benchmark& benchmark = benchmarkOf(options.name);
    for (const std::string& option : options.given) {
        if (std::ranges::find(benchmark.takes, option) != benchmark.takes.end()) continue;
        throw WrongUsage(fmt::format("`bench {}` has no option {}", options.name, option),
                         fmt::format("expected it with {}", whoTakes(option)));
    }
    const auto& strands = options.measuring.strands;
    if (const auto at = std::ranges::adjacent_find(strands, std::ranges::greater_equal());
        at != strands.end())
        throw WrongUsage(fmt::format("--strands has {} behind {}", at[1], at[0]),
                         "expected numbers in ascending order");
}

Result<Report> bench(const BenchOptions& options, const std::string& commandLine) {
    checkOptions(options);
    benchmarks::Options measuring = options.measuring;
    measuring.commandLine = commandLine;
    if (!options.size.empty()) measuring.size = orWrongUsage(parseSize(options.size));
    std::unique_ptr<Progress> progress;
    measuring.progress = [&](std::string_view what, std::size_t done, std::size_t total) {
        if (!progress) progress = std::make_unique<Progress>(std::string(what), total);
        progress->done(done);
    };
    auto outcome = benchmarkOf(options.name).run(measuring);
    progress.reset();
    if (!outcome) return tl::unexpected(outcome.error());
    if (!options.markdown.empty()) {
        if (auto written = writeFileAtomically(options.markdown, outcome->markdown); !written)
            return tl::unexpected(written.error());
        outcome->report["output"] = options.markdown;
    }
    if (!options.output.empty()) {
        const auto written = writeFiles(options.output, outcome->files);
        if (!written) return tl::unexpected(written.error());
        outcome->report["output"] = *written;
    }
    return std::move(outcome->report);
}

std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const Benchmark& benchmark : benchmarks::benchmarks()) all.push_back(benchmark.name);
    return all;
}

std::string namesInWords() {
    constexpr int kColumn = 13;
    std::string text = "What to measure";
    for (const Benchmark& benchmark : benchmarks::benchmarks())
        text += fmt::format("\n{:<{}}{}", benchmark.name, kColumn, benchmark.measures);
    return text;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<BenchOptions>();
    job.add_option("name", options->name, namesInWords())->required()->check(CLI::IsMember(names()));
    auto* const repetitions =
        job.add_option("--repeat,--repetitions", options->repetitions, "Runs of each measurement")
            ->check(CLI::Range(1, 1000));
    std::vector<CLI::Option*> some;
    const auto of = [](const char* option, const char* does) {
        return fmt::format("{}: {}", whoTakes(option), does);
    };
    some.push_back(job.add_option("--strands", options->measuring.strands,
                                  of("--strands", "numbers of strands, in ascending order"))
                       ->delimiter(',')
                       ->check(CLI::Range(1, 1'000'000)));
    some.push_back(
        job.add_flag("--quick", options->measuring.quick, of("--quick", "shorter runs, as a quick check")));
    some.push_back(job.add_option("--markdown", options->markdown, of("--markdown", "file for the tables")));
    some.push_back(job.add_option("--hairs", options->measuring.hairs,
                                  of("--hairs", "numbers of hairs, instead of 3100,9300,18300,100000"))
                       ->delimiter(',')
                       ->check(CLI::Range(1, 1'000'000)));
    some.push_back(
        job.add_option("--grooms", options->measuring.grooms,
                       of("--grooms", "samples by name, project files, or 100000x16, separated by commas"))
            ->delimiter(','));
    some.push_back(
        job.add_option("--only", options->measuring.only,
                       of("--only", "rows with one of these words in their names, as FXAA,shadows"))
            ->delimiter(','));
    some.push_back(job.add_option("--frames", options->measuring.frames, of("--frames", "frames per row"))
                       ->check(CLI::Range(1, 100'000)));
    some.push_back(
        job.add_option("--size", options->size, of("--size", "size WxH of all images, in pixels")));
    some.push_back(job.add_option("-o,--output", options->output,
                                  of("--output", "folder for the table, its Markdown and the chart")));
    auto* const device =
        job.add_option("--device", options->device, of("--device", "GPU index, as listed by `devices`"));
    some.push_back(device);
    job.final_callback([options, repetitions, device, some] {
        if (repetitions->count() > 0) options->measuring.repetitions = options->repetitions;
        if (device->count() > 0) options->measuring.device = options->device;
        for (const CLI::Option* option : some) {
            if (option->count() > 0) options->given.push_back("--" + option->get_lnames().front());
        }
    });
    return [options](const std::string& commandLine) {
        return withOutputFolder(options->output, {}, [&] {
            return withOutputs({{options->markdown}}, [&] { return bench(*options, commandLine); });
        });
    };
}

}  // namespace

Job benchJob() {
    return {"bench", "Measure a part of Hairloom on this machine, as medians of several runs",
            "sim --quick --json", declare};
}

}  // namespace hairloom::cli
