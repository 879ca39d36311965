// SPDX-License-Identifier: GPL-3.0-or-later
// What a moved control costs: the model and all its tables anew.

#include <benchmark/benchmark.h>

#include "core/shading/melanin.h"
#include "core/shading/tables.h"

namespace hairloom::shading {
namespace {

MarschnerParameters parameters(bool rough, double axisRatio) {
    MarschnerParameters result;
    result.azimuthal.absorption = absorption({0.3, 0});
    result.azimuthal.axisRatio = axisRatio;
    if (rough) {
        result.azimuthal.width = azimuthalWidth(0.3);
        result.azimuthal.causticWidth = 0;
    }
    return result;
}

void bake(benchmark::State& state, const MarschnerParameters& p) {
    for (auto _ : state) {
        const Marschner model(p);
        benchmark::DoNotOptimize(bakeMarschner(model));
        benchmark::DoNotOptimize(bakeDual(DualScattering(model)));
    }
}

void marschnerRough(benchmark::State& state) {
    bake(state, parameters(true, 1));
}
BENCHMARK(marschnerRough)->Unit(benchmark::kMillisecond)->UseRealTime();

void marschnerSmooth(benchmark::State& state) {
    bake(state, parameters(false, 1));
}
BENCHMARK(marschnerSmooth)->Unit(benchmark::kMillisecond)->UseRealTime();

void marschnerElliptic(benchmark::State& state) {
    bake(state, parameters(true, 1.2));
}
BENCHMARK(marschnerElliptic)->Unit(benchmark::kMillisecond)->UseRealTime();

void sadeghi(benchmark::State& state) {
    const SadeghiParameters p = sadeghiLike(Marschner(parameters(true, 1)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(bakeSadeghi(p));
        benchmark::DoNotOptimize(bakeDual(DualScattering(p)));
    }
}
BENCHMARK(sadeghi)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace hairloom::shading
