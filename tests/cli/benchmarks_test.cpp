// SPDX-License-Identifier: GPL-3.0-or-later
// How benchmarks measure; how long anything takes is not tested.
#include <gmock/gmock.h>

#include <chrono>
#include <set>
#include <thread>

#include "benchmarks/measurement.h"

namespace hairloom::benchmarks {
namespace {

using namespace std::chrono_literals;

TEST(Benchmarks, AreNamedOnceAndSayWhatTheyMeasure) {
    std::set<std::string> names;
    for (const Benchmark& benchmark : benchmarks()) {
        EXPECT_TRUE(names.insert(benchmark.name).second) << benchmark.name;
        EXPECT_FALSE(benchmark.measures.empty()) << benchmark.name;
    }
    for (const char* name : {"sim", "interpolate", "gpu-sim", "render", "place", "io", "brush", "runtime"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Benchmarks, RoundsLeaveOutWhatIsPaused) {
    Rounds rounds(0.01);
    int count = 0;
    while (rounds.next()) {
        ++count;
        rounds.pause();
        std::this_thread::sleep_for(20ms);
        rounds.resume();
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_GE(count, 1);
    EXPECT_LE(count, 2);
    EXPECT_GE(rounds.milliseconds(), 5.0);
}

TEST(Benchmarks, TimingsRepeatAndStopAtTheFirstFailure) {
    Options options;
    options.repetitions = 3;
    options.quick = true;
    Timings good(options);
    good.measure("nothing", [](Rounds& rounds) -> Status {
        while (rounds.next()) std::this_thread::sleep_for(1ms);
        return {};
    });
    const auto outcome = good.outcome("all");
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->report["name"], "all");
    ASSERT_EQ(outcome->report["rows"].size(), 1u);
    const auto& row = outcome->report["rows"][0];
    EXPECT_EQ(row["n"], 3);
    EXPECT_LE(row["min"], row["median"]);
    EXPECT_LE(row["median"], row["max"]);
    EXPECT_EQ(row["unit"], "ms");

    Timings bad(options);
    bad.measure("broken", [](Rounds&) -> Status { return fail("it is broken"); });
    bad.measure("not reached", [](Rounds&) -> Status {
        ADD_FAILURE();
        return {};
    });
    EXPECT_FALSE(bad.outcome("all"));
}

}  // namespace
}  // namespace hairloom::benchmarks
