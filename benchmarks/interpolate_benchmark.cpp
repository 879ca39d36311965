// SPDX-License-Identifier: GPL-3.0-or-later
// 2,000 guides into 100,000 follow hairs of 16 points on one thread, at rest and with speed-dependent
// wisps: bindings packed for the engine and evaluated once, as for a picture. bench_follow times frames.

#include <benchmark/benchmark.h>

#include "core/base/parallel.h"
#include "core/interpolation/follow_hairs.h"
#include "tests/interpolation/guide_grid.h"

namespace {

using namespace hairloom;

Groom lawn() {
    return test::guidesOnGrid({50, 40, 16, 0.005f, 0.2f}, [](std::uint32_t) { return 0.05f; });
}

InterpolationSettings fiftyEach() {
    InterpolationSettings settings;
    settings.followPerGuide = 50;
    return settings;
}

void evaluate(benchmark::State& state) {
    setThreadCount(1);
    const Groom groom = lawn();
    const auto bindings = bindFollowHairs(groom, fiftyEach());
    const auto guides = guidePositions(groom, *bindings);
    const std::vector<Vec3f> velocities(state.range(0) ? guides.size() : 0, Vec3f(1, 0, 0));
    std::vector<Vec3f> positions(bindings->hairCount() * bindings->pointsPerHair);
    for (auto step : state) {
        auto status = evaluateFollowHairs(*bindings, {guides, velocities, {}}, {}, positions);
        benchmark::DoNotOptimize(status);
        benchmark::ClobberMemory();
    }
    setThreadCount(0);
}

void bind(benchmark::State& state) {
    const Groom groom = lawn();
    for (auto step : state) {
        auto bindings = bindFollowHairs(groom, fiftyEach());
        benchmark::DoNotOptimize(bindings);
    }
}

BENCHMARK(evaluate)->ArgName("moving")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(bind)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
