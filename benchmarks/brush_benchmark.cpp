// SPDX-License-Identifier: GPL-3.0-or-later
// Dabs, strokes, undo and picking on combedHair(). A dab has a radius of 2 cm. Times are those of what the
// name says alone; window_benchmark has them as a person waits for them.

#include <benchmark/benchmark.h>

#include <cmath>

#include "benchmarks/combed_hair.h"
#include "core/editing/document.h"
#include "core/editing/picking.h"

namespace hairloom::editing {
namespace {

Document& document() {
    static Document shared(combedHair());
    return shared;
}

Stroke strokeOf(std::string_view tool) {
    Stroke stroke;
    stroke.tool = tool;
    if (tool == "cut_line") stroke.settings.depth = 0.05f;
    if (tool == "add") stroke.settings.parameters["density"] = 500;  // twice what is there
    for (int i = 0; i < 24; ++i) {
        stroke.dabs.push_back(dabAt(stroke.settings, onCombedHair(-60.0f + 5.0f * static_cast<float>(i))));
        if (tool == "cut_line") stroke.dabs.back().direction_ss = -Vec3f::UnitZ();
    }
    return stroke;
}

/// One dab after the other of a stroke that is begun anew when it ends; what skin there is to measure is
/// measured before.
void dab(benchmark::State& state, std::string_view tool) {
    const Stroke stroke = strokeOf(tool);
    static_cast<void>(document().replay(stroke));
    document().undo();
    std::size_t next = 0;
    double strands = 0;
    double dabs = 0;
    const Subscription subscription = document().observe(
        [&](const Change& change) { strands += static_cast<double>(change.strands.size()); });
    static_cast<void>(document().beginStroke(stroke));
    for (auto _ : state) {
        benchmark::DoNotOptimize(document().dab(stroke.dabs[next]));
        ++dabs;
        if (++next < stroke.dabs.size()) continue;
        state.PauseTiming();
        next = 0;
        document().cancelStroke();
        static_cast<void>(document().beginStroke(stroke));
        state.ResumeTiming();
    }
    document().cancelStroke();
    state.counters["strands_per_dab"] = strands / std::max(1.0, dabs);
}

void undoStroke(benchmark::State& state, std::string_view tool) {
    static_cast<void>(document().replay(strokeOf(tool)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(document().undo());
        state.PauseTiming();
        document().redo();
        state.ResumeTiming();
    }
    state.counters["megabytes"] = static_cast<double>(document().history().bytes()) / 1e6;
    document().undo();
}

void pickOneStrand(benchmark::State& state) {
    const Vec3f eye(0, 0.05f, 0.8f);
    Mat4f view = Mat4f::Identity();
    view.topRightCorner<3, 1>() = -eye;
    Mat4f projection = Mat4f::Zero();
    const float scale = 1 / std::tan(radians(12.0f));
    projection(0, 0) = scale * 9 / 16;
    projection(1, 1) = scale;
    projection(2, 2) = -1.01f;
    projection(2, 3) = -0.101f;
    projection(3, 2) = -1;
    const View seen(view, projection, Vec2f(1920, 1080));
    document().bounds();
    document().surface();
    float x = 700;
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            pickStrand(document().groom(), document().bounds(), document().surface(), seen, Vec2f(x, 400)));
        x = x < 1200 ? x + 7 : 700;
    }
}

constexpr auto kMs = benchmark::kMillisecond;
BENCHMARK_CAPTURE(dab, comb, "comb")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, brush, "brush")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, grab, "grab")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, smooth, "smooth")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, puff, "puff")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, pinch, "pinch")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, length, "length")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, cut, "cut")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, cut_line, "cut_line")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, add, "add")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, delete, "delete")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(dab, freeze, "freeze")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(undoStroke, comb, "comb")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(undoStroke, delete, "delete")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(undoStroke, add, "add")->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();
BENCHMARK(pickOneStrand)->Unit(kMs)->MinTime(0.2)->MeasureProcessCPUTime();

}  // namespace
}  // namespace hairloom::editing
