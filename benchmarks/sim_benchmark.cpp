// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of the strand engine on one thread: nanoseconds per particle and substep, per set of effects and per
// stage.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "runtime/engine.h"

namespace {

using namespace hairloom::runtime;

constexpr std::uint32_t kPoints = 16;
constexpr float kHeadRadius = 0.09f;

/// A head of hair: roots spread evenly over the upper three quarters of a sphere, strands of 0.3 m that curve
/// down.
struct Head {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions;
    std::vector<Float3> roots;
    std::vector<Sphere> spheres;

    explicit Head(std::uint32_t strands) {
        for (std::uint32_t s = 0; s < strands; ++s) {
            const float y = 1.0f - 1.5f * (static_cast<float>(s) + 0.5f) / static_cast<float>(strands);
            const float turn = static_cast<float>(s) * 2.39996323f;
            const float ring = std::sqrt(1.0f - y * y);
            Float3 direction{ring * std::cos(turn), y, ring * std::sin(turn)};
            Float3 at = direction * kHeadRadius;
            roots.push_back(at);
            for (std::uint32_t p = 0; p < kPoints; ++p) {
                positions.push_back(at);
                direction = direction + Float3{0.0f, -0.25f, 0.0f};
                direction = direction * (1.0f / length(direction));
                at = at + direction * (0.3f / (kPoints - 1));
            }
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        }
        spheres.push_back({{0.0f, 0.0f, 0.0f}, 0.088f});
        for (int i = 0; i < 9; ++i) {
            const float a = static_cast<float>(i) * std::numbers::pi_v<float> / 4.5f;
            spheres.push_back({{0.12f * std::cos(a), -0.2f, 0.08f * std::sin(a)}, 0.06f});
        }
    }
};

enum Effects { kIntegratorOnly, kNoWindNoSpheres, kAll };

SimulationSettings settingsFor(int effects) {
    SimulationSettings s;
    if (effects == kIntegratorOnly) {
        s.angularStiffness = 0.0f;
        s.lengthIterations = 0;
        s.gravity = {};
    }
    if (effects != kAll) s.airDrag = 0.0f;
    if (effects == kAll) s.windSpeed = 4.0f;
    return s;
}

void runFrames(benchmark::State& state, Host host, bool perStage) {
    const auto strands = static_cast<std::uint32_t>(state.range(0));
    const auto effects = static_cast<int>(state.range(1));
    const Head head(strands);
    const SimulationSettings settings = settingsFor(effects);
    auto made = Engine::make({head.offsets, head.positions, {}}, settings, std::move(host));
    Engine& engine = *made.engine;
    std::vector<RootFrame> roots(strands);
    FrameInput input;
    if (effects == kAll) input.spheres = head.spheres;
    std::array<double, kStageCount> sums{};
    for (auto _ : state) {
        input.time += 1.0 / 60.0;
        const float angle = 0.3f * std::sin(static_cast<float>(input.time) * 6.0f);
        const Quat turn{0.0f, std::sin(angle / 2.0f), 0.0f, std::cos(angle / 2.0f)};
        for (std::uint32_t s = 0; s < strands; ++s) roots[s] = {rotate(turn, head.roots[s]), turn};
        input.roots_ws = roots;
        engine.step(input);
        for (std::size_t i = 0; i < kStageCount; ++i) sums[i] += engine.lastStep().stageMilliseconds[i];
    }
    const double work = static_cast<double>(state.iterations()) * strands * kPoints * settings.substeps;
    state.counters["ns/particle/substep"] =
        benchmark::Counter(work * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
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
    ->ArgNames({"strands", "effects"})
    ->ArgsProduct({{300, 11400}, {kIntegratorOnly, kNoWindNoSpheres, kAll}})
    ->Unit(benchmark::kMillisecond);

/// The same with a clock around each stage; a stage's counter is its nanoseconds per particle and substep.
void simulateByStage(benchmark::State& state) {
    Host host;
    host.nanoseconds = [] {
        return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    };
    runFrames(state, std::move(host), true);
}
BENCHMARK(simulateByStage)
    ->ArgNames({"strands", "effects"})
    ->Args({11400, kAll})
    ->Unit(benchmark::kMillisecond);

}  // namespace
