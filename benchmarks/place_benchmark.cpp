// SPDX-License-Identifier: GPL-3.0-or-later
// Root placement on a scalp-sized cap (about 500 cm²), and repair of a mesh of 20,000 vertices.

#include <benchmark/benchmark.h>

#include <cmath>

#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

struct Scalp {
    ScalpMesh mesh = test::meshOf(test::icosphereSoup(4, 0.09f));
    FaceSet faces = *selectFaces(mesh, "cap:90");
};

const Scalp& scalp() {
    static const Scalp kScalp;
    return kScalp;
}

PlacementRequest request(const benchmark::State& state) {
    PlacementRequest result;
    result.count = static_cast<std::size_t>(state.range(0));
    result.seed = 1;
    return result;
}

void placeAtRandom(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(placeRandom(scalp().mesh, scalp().faces, request(state)));
}
BENCHMARK(placeAtRandom)->Arg(100'000)->Unit(benchmark::kMillisecond);

void placeByDarts(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(placeDarts(scalp().mesh, scalp().faces, request(state)));
}
BENCHMARK(placeByDarts)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);

void placeMaximally(benchmark::State& state) {
    const double area = selectionArea(scalp().mesh, scalp().faces);
    const auto radius = static_cast<float>(std::sqrt(0.6965 * area / static_cast<double>(state.range(0))));
    std::size_t roots = 0;
    for (auto _ : state)
        roots = placeDartsWithRadius(scalp().mesh, scalp().faces, radius, {}, 1)->roots.size();
    state.counters["roots"] = static_cast<double>(roots);
}
BENCHMARK(placeMaximally)->Arg(100'000)->Unit(benchmark::kMillisecond);

void repairMesh(benchmark::State& state) {
    const PolygonSoup soup = test::gridSoup(141, 1);
    for (auto _ : state) benchmark::DoNotOptimize(ScalpMesh::make(soup));
}
BENCHMARK(repairMesh)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hairloom
