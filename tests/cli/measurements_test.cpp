// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/measurements.h"

#include <gtest/gtest.h>

namespace hairloom::cli {
namespace {

/// As Google Benchmark 1.7 writes it where a counter stays 0: its variation is 0/0.
TEST(Measurements, TakeWhatStandsBesideStatisticsThatAreNoNumbers) {
    const auto measured = measurementsOf(R"({"context": {"host_name": "a \"NaN\" box \\"}, "benchmarks": [
        {"name": "write/NaN", "run_type": "iteration", "real_time": 2.5e+0, "time_unit": "ms", "left": 0.0},
        {"name": "write/NaN", "run_type": "iteration", "real_time": 3.5e+0, "time_unit": "ms", "left": -Infinity},
        {"name": "write/NaN_cv", "run_type": "aggregate", "real_time": -NaN, "time_unit": "ms", "left": NaN},
        {"name": "broken", "run_type": "iteration", "error_occurred": true}]})");
    ASSERT_TRUE(measured) << measured.error().message();
    ASSERT_EQ(measured->size(), 1u);
    EXPECT_EQ(measured->front().name, "write/NaN");
    EXPECT_EQ(measured->front().unit, "ms");
    EXPECT_EQ(measured->front().values, (std::vector<double>{2.5, 3.5}));
}

TEST(Measurements, RefuseWhatIsNoBenchmark) {
    EXPECT_FALSE(measurementsOf("Segmentation fault"));
    EXPECT_FALSE(measurementsOf(R"({"results": []})"));
    EXPECT_FALSE(measurementsOf("[1, 2]"));
}

}  // namespace
}  // namespace hairloom::cli
