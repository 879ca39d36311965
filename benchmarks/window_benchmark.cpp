// SPDX-License-Identifier: GPL-3.0-or-later
// What a person waits for in the editor's window, measured by the program bench_window beside this one.

#include <fmt/format.h>

#include "benchmarks/benchmark.h"
#include "importers/child_process.h"

namespace hairloom::benchmarks {
namespace {

Result<Outcome> runWindow(const Options& options) {
    ChildLimits limits;
    limits.time = std::chrono::hours(1);
    limits.residentBytes = std::uint64_t{16} << 30u;
    std::vector<std::string> arguments;
    if (options.repetitions) arguments.push_back(fmt::format("--repeat={}", *options.repetitions));
    if (options.quick) arguments.emplace_back("--quick");
    const auto output = runChild("the benchmark", programFolder() / "bench_window", arguments, limits);
    if (!output) return tl::unexpected(output.error());
    const void* const text = output->data();
    Outcome outcome;
    outcome.report =
        Report::parse(std::string_view(static_cast<const char*>(text), output->size()), nullptr, false);
    if (outcome.report.is_discarded()) return fail("bench_window did not write JSON");
    return outcome;
}

}  // namespace

Benchmark windowBenchmark() {
    return {"window", "delays that a user notices in the editor", {"--quick"}, runWindow};
}

}  // namespace hairloom::benchmarks
