// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "core/base/profiler.h"

namespace hairloom {
namespace {

TEST(Parallel, CutsTheSamePiecesForAnyNumberOfThreads) {
    const auto pieceOfEach = [](std::size_t threads) {
        setThreadCount(threads);
        std::vector<std::size_t> start(1000);
        parallelFor(start.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) start[i] = begin;
        });
        setThreadCount(0);
        return start;
    };
    const auto one = pieceOfEach(1);
    EXPECT_EQ(one, pieceOfEach(4));
    EXPECT_EQ(one[999], 960u);
}

TEST(Parallel, EmptyRangeCallsNothing) {
    std::atomic<int> calls{0};
    parallelFor(0, 8, [&](std::size_t, std::size_t) { ++calls; });
    EXPECT_EQ(calls, 0);
}

TEST(Profiler, AddsUpScopesOfOneName) {
    profiler::reset();
    for (int i = 0; i < 3; ++i) {
        HAIRLOOM_PROFILE("profiler test");
    }
    { HAIRLOOM_PROFILE("profiler test"); }
    const auto rows = profiler::report();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].name, "profiler test");
    EXPECT_EQ(rows[0].calls, 4u);
}

}  // namespace
}  // namespace hairloom
