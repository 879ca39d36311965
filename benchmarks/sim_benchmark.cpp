// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of the strand engine on one thread: nanoseconds per particle and substep, per set of effects and per
// stage. `hairloom-cli bench sim` measures more of it on the same scene.
#include <benchmark/benchmark.h>

#include <chrono>
#include <string>
#include <vector>

#include "core/accuracy/benchmark_scenes.h"

namespace {

using namespace hairloom::runtime;
using namespace hairloom::scenes;

constexpr std::uint32_t kPoints = 16;

std::uint64_t nanosecondsNow() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

/// The roots of a frame are made before its clock runs.
void runFrames(benchmark::State& state, Host host, bool perStage) {
    const auto activeForces = static_cast<ActiveForces>(state.range(1));
    const HeadOfHair head(static_cast<std::uint32_t>(state.range(0)), kPoints, isStraight(activeForces));
    const SimulationSettings settings = settingsFor(activeForces);
    auto made = Engine::make(head.view(), settings, std::move(host));
    Engine& engine = *made.engine;
    std::vector<RootFrame> roots;
    FrameInput input;
    if (hasSpheres(activeForces)) input.spheres = head.spheres;
    std::array<double, kStageCount> sums{};
    std::uint64_t spent = 0;
    for (auto _ : state) {
        input.time += static_cast<double>(input.dt);
        head.placeRoots(input.time, roots);
        input.roots_ws = roots;
        const std::uint64_t begin = nanosecondsNow();
        engine.step(input);
        const std::uint64_t took = nanosecondsNow() - begin;
        state.SetIterationTime(static_cast<double>(took) * 1e-9);
        spent += took;
        for (std::size_t i = 0; i < kStageCount; ++i) sums[i] += engine.lastStep().stageMilliseconds[i];
    }
    const double work = static_cast<double>(state.iterations()) * engine.pointCount() *
                        static_cast<double>(settings.substeps);
    state.counters["ns/particle/substep"] = static_cast<double>(spent) / work;
    if (perStage) {
        for (const StageId id : engine.plan().stages()) {
            state.counters[stageName(id)] = sums[static_cast<std::size_t>(id)] * 1e6 / work;
        }
    }
    const Measurements m = engine.measure();
    state.counters["stretch"] = m.maxStretch;
    state.counters["penetration_mm"] = m.maxPenetration * 1e3;
    state.SetLabel(Engine::instructionSet());
}

void simulate(benchmark::State& state) {
    runFrames(state, {}, false);
}
BENCHMARK(simulate)
    ->ArgNames({"strands", "acting"})
    ->ArgsProduct({{300, 2000, 11400}, {0, 1, 2, 3}})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

/// The same with a clock around each stage; a stage's counter is its nanoseconds per particle and substep.
void simulateByStage(benchmark::State& state) {
    Host host;
    host.nanoseconds = nanosecondsNow;
    runFrames(state, std::move(host), true);
}
BENCHMARK(simulateByStage)
    ->ArgNames({"strands", "acting"})
    ->Args({11400, static_cast<int>(ActiveForces::windAndSpheres)})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

}  // namespace
