// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Repeated measurements, and the programs that make some of them.

#include <string>
#include <string_view>
#include <vector>

#include "cli/job.h"

namespace hairloom::cli {

/// The repetitions of one measurement, in the order in which they ran; at least one.
struct Measurement {
    std::string name;
    std::string unit;
    std::vector<double> values;

    double median() const;
};

/// name, n, median, min, max, unit.
Report rowOf(const Measurement& measurement);

/// The real times that a benchmark program wrote. Errors: that is not Google Benchmark's JSON.
Result<std::vector<Measurement>> measurementsOf(std::string_view benchmarkJson);

/// Runs bench_NAME, which must lie beside this program, and returns the real times of its measurements.
/// Errors: it is not there, fails, or writes what is not Google Benchmark's JSON.
Result<std::vector<Measurement>> runBenchmarkProgram(const std::string& name, int repetitions,
                                                     const std::vector<std::string>& arguments = {});

}  // namespace hairloom::cli
