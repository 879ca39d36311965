// SPDX-License-Identifier: GPL-3.0-or-later
// How long a frame is held up by a control of the material that has moved: recording it, with the tables of
// the model baked in place or behind. Needs a device; what the device does afterwards is not in it.

#include <benchmark/benchmark.h>

#include <array>

#include "core/gpu/device.h"
#include "core/render/renderer.h"

namespace hairloom::render {
namespace {

/// One hair: what is measured does not depend on how many there are.
struct OneHair {
    std::array<std::uint32_t, 2> offsets{0, 2};
    std::array<Vec3f, 2> positions{Vec3f(0, -0.05f, 0), Vec3f(0, 0.05f, 0)};
    RenderScene scene;

    OneHair() {
        RenderStrands strands;
        strands.offsets = offsets;
        strands.positions_ws = positions;
        strands.material.fibre.model = ShadingModel::marschner;
        scene.strands = {strands};
        scene.camera.eye_ws = {0, 0, 0.5f};
        scene.camera.target_ws = Vec3f::Zero();
    }
};

void controlMoves(benchmark::State& state, bool behind) {
    const auto device = gpu::createDevice({});
    if (!device) return state.SkipWithError(device.error().message().c_str());
    OneHair hair;
    Renderer renderer(**device);
    if (!renderer.setScene(hair.scene)) return state.SkipWithError("the scene was refused");
    RenderOptions options;
    options.width = options.height = 16;
    options.samples = 1;
    options.frames = 1;
    options.bakeBehind = behind;
    const auto drawFrame = [&](bool timed) {
        auto list = (*device)->createCommandList();
        if (!list) return false;
        if (timed) state.ResumeTiming();
        const bool good = renderer.record(**list, options, nullptr).has_value();
        if (timed) state.PauseTiming();
        const auto submitted = (*device)->submit(std::move(*list));
        return good && submitted && (*submitted)->wait().has_value();
    };
    if (!drawFrame(false)) return state.SkipWithError("the first frame failed");
    HairMaterial material = hair.scene.strands.front().material;
    for (auto _ : state) {
        state.PauseTiming();
        while (!renderer.isSettled() && drawFrame(false)) {
        }
        material.fibre.marschner.azimuthal.absorption.x() += 0.01;
        const bool set = renderer.setMaterial(0, material).has_value();
        if (!set || !drawFrame(true)) return state.SkipWithError("a frame failed");
        state.ResumeTiming();
    }
}

void tablesInPlace(benchmark::State& state) {
    controlMoves(state, false);
}
BENCHMARK(tablesInPlace)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(50);

void tablesBehind(benchmark::State& state) {
    controlMoves(state, true);
}
BENCHMARK(tablesBehind)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(50);

}  // namespace
}  // namespace hairloom::render
