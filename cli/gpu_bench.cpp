// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/gpu_bench.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "cli/backend.h"
#include "core/accuracy/step_cost.h"
#include "core/accuracy/thread_limit.h"

namespace hairloom::cli {
namespace {

/// What the rows of one table have in common.
class Rows {
  public:
    Rows(GpuBackend& backend, const GpuBenchOptions& options) : backend_(backend), options_(options) {}

    Result<GpuBenchRow> measure(std::uint32_t strands, LeftOut leftOut, const NamedLayout& layout) {
        GpuStepScene scene;
        scene.strands = strands;
        scene.leftOut = leftOut;
        scene.layout = layout.options;
        auto run = GpuStepRun::make(backend_.device(), backend_.kernels(), scene);
        if (!run) return tl::unexpected(run.error());
        const auto frames = run->framesFor(options_.seconds);
        if (!frames) return tl::unexpected(frames.error());
        // While the kernel was made, in the first of these frames, the device rested.
        if (auto fast = bringToSpeed(backend_.device(), options_.seconds); !fast)
            return tl::unexpected(fast.error());
        const auto cost = run->cost(*frames);
        if (!cost) return tl::unexpected(cost.error());
        GpuBenchRow row;
        row.strands = strands;
        row.leftOut = leftOutName(leftOut);
        row.layout = layout.name;
        row.gpu = *cost;
        const double bytes = static_cast<double>(run->engine().frameBytes());
        row.bytes = bytes / run->work();
        const double milliseconds = cost->device > 0.0 ? cost->device : cost->wall;
        row.bandwidth = bytes * 1e-6 / milliseconds;
        return row;
    }

    std::vector<NamedLayout> layouts() const { return measuredLayouts(backend_.device().info().type); }

    double onCpu(std::uint32_t strands, bool allThreads) const {
        StepScene scene;
        scene.strands = strands;
        scene.allThreads = allThreads;
        StepRun run(scene);
        return run.milliseconds(run.framesFor(options_.seconds));
    }

  private:
    GpuBackend& backend_;
    const GpuBenchOptions& options_;
};

Status measureFigure(Rows& rows, const GpuBenchOptions& options, GpuBench& bench) {
    std::vector<double> counts, gpu, one, all;
    for (const std::uint32_t strands : options.strands) {
        auto row = rows.measure(strands, LeftOut::nothing, rows.layouts().front());
        if (!row) return tl::unexpected(row.error());
        if (options.cpu) {
            row->cpuOne = rows.onCpu(strands, false);
            row->cpuAll = rows.onCpu(strands, true);
            counts.push_back(strands);
            gpu.push_back(row->gpu.wall);
            one.push_back(*row->cpuOne);
            all.push_back(*row->cpuAll);
        }
        bench.rows.push_back(std::move(*row));
    }
    bench.crossesOne = crossing(counts, gpu, one);
    bench.crossesAll = crossing(counts, gpu, all);
    return {};
}

Status measureDetails(Rows& rows, const GpuBenchOptions& options, GpuBench& bench) {
    const auto layouts = rows.layouts();
    for (const std::uint32_t strands : options.details) {
        for (const LeftOut leftOut : kLeftOut) {
            auto row = rows.measure(strands, leftOut, layouts.front());
            if (!row) return tl::unexpected(row.error());
            bench.effects.push_back(std::move(*row));
        }
        for (const NamedLayout& layout : layouts) {
            auto row = rows.measure(strands, LeftOut::nothing, layout);
            if (!row) return tl::unexpected(row.error());
            bench.layouts.push_back(std::move(*row));
        }
    }
    return {};
}

}  // namespace

Result<GpuBench> runGpuBench(const GpuBenchOptions& options) {
    auto backend = GpuBackend::make(gpu::Backend::Vulkan, options.device);
    if (!backend) return tl::unexpected(backend.error());
    const gpu::DeviceInfo& info = (*backend)->device().info();
    GpuBench bench;
    bench.device = info.name;
    bench.driver = info.driver;
    bench.date =
        fmt::format("{:%Y-%m-%d}", std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
    bench.machine = thisMachine();
    const auto bandwidth = copyBandwidth((*backend)->device());
    if (!bandwidth) return tl::unexpected(bandwidth.error());
    bench.copyBandwidth = *bandwidth;
    Rows rows(**backend, options);
    if (auto status = measureFigure(rows, options, bench); !status) return tl::unexpected(status.error());
    if (auto status = measureDetails(rows, options, bench); !status) return tl::unexpected(status.error());
    return bench;
}

}  // namespace hairloom::cli
