// SPDX-License-Identifier: GPL-3.0-or-later
// The editor's loop without its window: hair on a nodding head in wind, moved and drawn as the viewport does
// while something moves, by the engine on the GPU and by the one on the CPU.

#include <fmt/format.h>

#include "benchmarks/benchmark.h"
#include "benchmarks/sample_hair.h"
#include "core/live/live_cost.h"

namespace hairloom::benchmarks {
namespace {

constexpr float kWind = 4;  // m/s
/// A groom on an engine.
struct Row {
    std::string groom;
    EngineKind engine = EngineKind::cpu;
    LiveCost cost;
};

Result<Row> rowOf(LiveLoop& loop, const Sample& sample, EngineKind engine, std::uint32_t frames) {
    Groom groom = sample.groom;
    groom.simulation.windSpeed = kWind;
    const auto motion = makeRigidMotion("nod", groom);
    if (!motion) return tl::unexpected(motion.error());
    auto cost = loop.run(groom, **motion, engine, frames);
    if (!cost) return tl::unexpected(cost.error());
    return Row{sample.name, engine, std::move(*cost)};
}

Report reportOf(const Row& row) {
    return Report{{"groom", row.groom},
                  {"engine", engineName(row.engine)},
                  {"hairs", row.cost.hairs},
                  {"simulate_ms", row.cost.simulate},
                  {"follow_ms", row.cost.follow},
                  {"shadow_ms", row.cost.shadow},
                  {"shade_ms", row.cost.shade},
                  {"draw_ms", row.cost.draw},
                  {"frame_ms", row.cost.frame()},
                  {"wall_ms", row.cost.wall},
                  {"bytes_to_device", row.cost.toDevice},
                  {"bytes_from_device", row.cost.fromDevice},
                  {"point_bytes", row.cost.pointBytes},
                  {"passes", row.cost.passes}};
}

std::string markdownOf(const std::vector<Row>& rows, const Options& options, const gpu::DeviceInfo& device) {
    std::string text = fmt::format("`{}`\n\n{}, {}\n\n", options.commandLine, device.name, device.driver);
    text +=
        "| hairstyle | engine | hairs | simulate | follow | shadow | shade | draw | frame ms | wall ms | to "
        "device "
        "KB | from device KB |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Row& row : rows) {
        text += fmt::format(
            "| {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} "
            "|\n",
            row.groom, engineName(row.engine), row.cost.hairs, row.cost.simulate, row.cost.follow,
            row.cost.shadow, row.cost.shade, row.cost.draw, row.cost.frame(), row.cost.wall,
            row.cost.toDevice / 1000, row.cost.fromDevice / 1000);
    }
    return text;
}

Result<Outcome> runLive(const Options& options) {
    auto grooms = wantedHair(options);
    if (!grooms) return tl::unexpected(grooms.error());
    gpu::DeviceOptions wanted;
    wanted.index = options.device;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    const gpu::DeviceInfo& info = (*device)->info();
    const bool software = info.type == gpu::DeviceType::Cpu;
    if (options.grooms.empty() && !options.quick && !software) grooms->push_back(manyHairs());
    const auto kernels =
        std::make_shared<gpu_simulation::KernelLibrary>(**device, gpu_simulation::userKernelFolder());
    const auto size = options.size.value_or(software ? std::pair(320u, 180u) : std::pair(1920u, 1080u));
    const std::uint32_t frames = options.frames.value_or(options.quick ? 8 : software ? 20 : 240);
    LiveLoop loop(**device, kernels, size.first, size.second);
    std::vector<Row> rows;
    Outcome outcome;
    outcome.report = Report{{"name", "live"},      {"device", info.name},   {"driver", info.driver},
                            {"width", size.first}, {"height", size.second}, {"frames", frames}};
    Report all = Report::array();
    for (const Sample& groom : *grooms) {
        for (const EngineKind engine : {EngineKind::gpu, EngineKind::cpu}) {
            auto row = rowOf(loop, groom, engine, frames);
            if (!row) return tl::unexpected(row.error());
            all.push_back(reportOf(*row));
            rows.push_back(std::move(*row));
            if (options.progress) options.progress("playing", rows.size(), 2 * grooms->size());
        }
    }
    outcome.report["rows"] = std::move(all);
    outcome.markdown = markdownOf(rows, options, info);
    return outcome;
}

}  // namespace

Benchmark liveBenchmark() {
    return {"live",
            "the editor's loop without a window: hair simulated and rendered on the GPU and on the CPU",
            {"--quick", "--device", "--size", "--grooms", "--frames", "--markdown"},
            runLive};
}

}  // namespace hairloom::benchmarks
