// SPDX-License-Identifier: GPL-3.0-or-later
// How long a frame is held up by a control of the material that has moved: recording it, with the tables of
// the model baked in place or behind. What the device does afterwards is not in it, nor does it depend on how
// much hair there is.

#include <array>

#include "benchmarks/measurement.h"
#include "core/gpu/device.h"
#include "core/render/renderer.h"

namespace hairloom::benchmarks {
namespace {

struct OneHair {
    std::array<std::uint32_t, 2> offsets{0, 2};
    std::array<Vec3f, 2> positions{Vec3f(0, -0.05f, 0), Vec3f(0, 0.05f, 0)};
    render::RenderScene scene;

    OneHair() {
        render::RenderStrands strands;
        strands.offsets = offsets;
        strands.positions_ws = positions;
        strands.material.fibre.model = render::ShadingModel::marschner;
        scene.strands = {strands};
        scene.camera.eye_ws = {0, 0, 0.5f};
        scene.camera.target_ws = Vec3f::Zero();
    }
};

class Drawing {
  public:
    Drawing(gpu::Device& device, bool behind) : device_(device), renderer_(device) {
        options_.width = options_.height = 16;
        options_.samples = 1;
        options_.frames = 1;
        options_.bakeBehind = behind;
    }

    /// Begins and ends outside of the clock.
    Status controlMoves(Rounds& rounds) {
        if (auto status = renderer_.setScene(hair_.scene); !status) return status;
        if (auto status = drawFrame(nullptr); !status) return status;
        auto material = hair_.scene.strands.front().material;
        while (rounds.next()) {
            rounds.pause();
            while (!renderer_.isSettled()) {
                if (auto status = drawFrame(nullptr); !status) return status;
            }
            material.fibre.marschner.azimuthal.absorption.x() += 0.01;
            if (auto status = renderer_.setMaterial(0, material); !status) return status;
            if (auto status = drawFrame(&rounds); !status) return status;
            rounds.resume();
        }
        return {};
    }

  private:
    Status drawFrame(Rounds* timed) {
        auto list = device_.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (timed) timed->resume();
        auto status = renderer_.record(**list, options_, nullptr);
        if (timed) timed->pause();
        if (!status) return status;
        const auto submitted = device_.submit(std::move(*list));
        if (!submitted) return tl::unexpected(submitted.error());
        return (*submitted)->wait();
    }

    gpu::Device& device_;
    OneHair hair_;
    render::Renderer renderer_;
    render::RenderOptions options_;
};

Result<Outcome> runMaterial(const Options& options) {
    gpu::DeviceOptions wanted;
    wanted.index = options.device;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    Timings timings(options);
    timings.measure("tables in place",
                    [&](Rounds& rounds) { return Drawing(**device, false).controlMoves(rounds); });
    timings.measure("tables behind",
                    [&](Rounds& rounds) { return Drawing(**device, true).controlMoves(rounds); });
    return timings.outcome("material");
}

}  // namespace

Benchmark materialBenchmark() {
    return {"material", "changing a setting of the material", {"--device", "--quick"}, runMaterial};
}

}  // namespace hairloom::benchmarks
