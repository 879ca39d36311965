// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of follow hairs: 300 moving guides into 18,300 hairs of 16 points, on one thread and on all.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "runtime/follow.h"

namespace {

using namespace hairloom::runtime;

constexpr std::uint32_t kPoints = 16;
constexpr std::uint32_t kGuides = 300;
constexpr std::uint32_t kHairsPerGuide = 61;
constexpr std::uint32_t kColumns = 20;

/// Guides on a lattice, curved over; hair h of a guide lies in the triangle of the guide and two neighbours.
struct Lawn {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions, velocities;
    std::vector<Quat> rotations{kGuides, Quat{}};
    std::vector<RootPlane> planes{kGuides,
                                  RootPlane{{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}}};
    std::vector<float> radii;
    std::vector<std::array<std::uint32_t, 3>> guides;
    std::vector<Float3> weights, rootShifts;
    std::vector<std::array<float, 2>> wispOffsets;
    std::vector<float> blends;

    Lawn(float blend, std::uint32_t hairsPerGuide) {
        for (std::uint32_t g = 0; g < kGuides; ++g) {
            const Float3 root{0.005f * static_cast<float>(g % kColumns), 0.0f,
                              0.005f * static_cast<float>(g / kColumns)};
            for (std::uint32_t i = 0; i < kPoints; ++i) {
                const float t = static_cast<float>(i) / (kPoints - 1);
                positions.push_back(root + Float3{0.05f * t * t, 0.2f * t, 0.01f * std::sin(6.0f * t)});
                velocities.push_back({t, 0.0f, 0.3f * t});
            }
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
            addHairs(g, blend, hairsPerGuide);
        }
        for (std::uint32_t i = 0; i < kPoints; ++i) radii.push_back(0.002f + 0.0001f * static_cast<float>(i));
    }
    FollowView view() const {
        return {offsets, {},      planes,      kPoints, radii,     guides,
                weights, weights, wispOffsets, blends,  rootShifts};
    }

  private:
    void addHairs(std::uint32_t guide, float blend, std::uint32_t count) {
        for (std::uint32_t h = 0; h < count; ++h) {
            const float share = static_cast<float>(h) / static_cast<float>(count);
            const std::uint32_t beside = guide % kColumns + 1 < kColumns ? guide + 1 : guide - 1;
            const std::uint32_t behind = guide + kColumns < kGuides ? guide + kColumns : guide - kColumns;
            guides.push_back({guide, beside, behind});
            weights.push_back({0.5f, 0.5f * share, 0.5f - 0.5f * share});
            rootShifts.push_back({0.0f, 0.0f, 1e-4f * share});
            wispOffsets.push_back({std::cos(40.0f * share), share * std::sin(40.0f * share)});
            blends.push_back(blend);
        }
    }
};

void runFrames(benchmark::State& state, const Host& host) {
    const Lawn lawn(0.01f * static_cast<float>(state.range(0)), kHairsPerGuide);
    auto made = FollowHairs::make(lawn.view());
    if (!made.hairs) {
        state.SkipWithError(made.error.c_str());
        return;
    }
    std::vector<Float3> hairs(lawn.guides.size() * kPoints);
    for (auto step : state) {
        made.hairs->evaluate({lawn.positions, lawn.velocities, lawn.rotations}, hairs, host);
        benchmark::ClobberMemory();
    }
    const double work = static_cast<double>(state.iterations()) * static_cast<double>(hairs.size());
    state.counters["ns/point"] =
        benchmark::Counter(work * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
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
    const Lawn lawn(0.5f, 0);
    auto made = FollowHairs::make(lawn.view());
    for (auto step : state) {
        made.hairs->evaluate({lawn.positions, lawn.velocities, lawn.rotations}, {});
        benchmark::ClobberMemory();
    }
}

void make(benchmark::State& state) {
    const Lawn lawn(0.5f, kHairsPerGuide);
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
