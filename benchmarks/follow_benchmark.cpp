// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of follow hairs: 300 moving guides into 18,300 hairs of 16 points, on one thread and on all.
#include <benchmark/benchmark.h>

#include <chrono>
#include <vector>

#include "core/accuracy/benchmark_scenes.h"
#include "core/base/parallel.h"

namespace {

using namespace hairloom::runtime;
using hairloom::scenes::Lawn;

constexpr std::uint32_t kPoints = 16;
constexpr std::uint32_t kGuides = 300;
constexpr std::uint32_t kHairsPerGuide = 61;
void runFrames(benchmark::State& state, const Host& host) {
    const Lawn lawn(kGuides, kHairsPerGuide, kPoints, 0.01f * static_cast<float>(state.range(0)));
    auto made = FollowHairs::make(lawn.view());
    if (!made.hairs) {
        state.SkipWithError(made.error.c_str());
        return;
    }
    std::vector<Float3> hairs(lawn.hairPointCount());
    const auto begin = std::chrono::steady_clock::now();
    for (auto step : state) {
        made.hairs->evaluate(lawn.motion(), hairs, host);
        benchmark::ClobberMemory();
    }
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    state.counters["ns/point"] =
        spent.count() / (static_cast<double>(state.iterations()) * static_cast<double>(hairs.size()));
}

void oneThread(benchmark::State& state) {
    runFrames(state, {});
}
void allThreads(benchmark::State& state) {
    Host host;
    host.parallelFor = hairloom::parallelFor;
    runFrames(state, host);
}

/// What a frame costs before the first hair: frames, wisps and rows of the guides.
void guidesAlone(benchmark::State& state) {
    const Lawn lawn(kGuides, 0, kPoints, 0.5f);
    auto made = FollowHairs::make(lawn.view());
    for (auto step : state) {
        made.hairs->evaluate(lawn.motion(), {});
        benchmark::ClobberMemory();
    }
}

void make(benchmark::State& state) {
    const Lawn lawn(kGuides, kHairsPerGuide, kPoints, 0.5f);
    for (auto step : state) {
        auto made = FollowHairs::make(lawn.view());
        benchmark::DoNotOptimize(made);
    }
}

BENCHMARK(oneThread)->ArgName("blend%")->Arg(0)->Arg(50)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(allThreads)->ArgName("blend%")->Arg(0)->Arg(50)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(guidesAlone)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(make)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
