// SPDX-License-Identifier: GPL-3.0-or-later
// 2,000 guides into 100,000 follow hairs of 16 points on one thread, at rest and with speed-dependent
// wisps: bindings packed for the engine and evaluated once, as for a picture. bench_follow times frames.

#include <benchmark/benchmark.h>

#include "core/base/parallel.h"
#include "core/interpolation/follow_hairs.h"

namespace {

using namespace hairloom;

constexpr std::uint32_t kColumns = 50;
constexpr std::uint32_t kRows = 40;
constexpr std::uint32_t kPoints = 16;

Groom lawn() {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < kColumns * kRows; ++s) {
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            const float t = static_cast<float>(i) / (kPoints - 1);
            positions.emplace_back(0.005f * static_cast<float>(s % kColumns) + 0.05f * t * t, 0.2f * t,
                                   0.005f * static_cast<float>(s / kColumns));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
        for (std::uint32_t column = 0; column + 1 < kColumns; ++column) {
            const std::uint32_t a = row * kColumns + column;
            groom.triangulation.triangles.push_back({a, a + kColumns, a + 1});
            groom.triangulation.triangles.push_back({a + 1, a + kColumns, a + kColumns + 1});
        }
    }
    return groom;
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
