// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/gpu_sim.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "benchmarks/sample_hair.h"
#include "core/gpu_simulation/kernel_library.h"

namespace hairloom::benchmarks {
namespace {

using scenes::ActiveForces;

constexpr std::uint32_t kPoints = 16;
constexpr runtime::StrandModel kRods = runtime::StrandModel::rods;

struct Extent {
    std::vector<std::uint32_t> strands{100, 200, 300, 1'000, 3'000, 10'000, 30'000, 100'000};
    /// Numbers of strands at which effects and layouts are told apart.
    std::vector<std::uint32_t> details{300, 10'000, 100'000};
    double seconds = 0.2;  ///< of one measurement, about
};

Extent extentOf(const Options& options) {
    Extent extent;
    if (options.quick) extent = {{100, 300}, {100}, 0.02};
    if (!options.strands.empty()) {
        extent.strands = options.strands;
        extent.details = {options.strands.back()};
    }
    return extent;
}

/// What the rows of one table have in common.
class Rows {
  public:
    Rows(gpu::Device& device, double seconds)
        : device_(device),
          kernels_(
              std::make_shared<gpu_simulation::KernelLibrary>(device, gpu_simulation::userKernelFolder())),
          seconds_(seconds) {}

    Result<GpuBenchRow> measure(std::uint32_t strands, LeftOut leftOut, runtime::StrandModel model,
                                const NamedLayout& layout) {
        const auto forces =
            leftOut == LeftOut::collision ? ActiveForces::gravity : ActiveForces::windAndSpheres;
        auto row = measure(turningHead(strands, kPoints, forces), settingsWithout(leftOut, model), layout);
        if (!row) return row;
        row->hair = model == runtime::StrandModel::rods ? "rods" : "springs";
        row->leftOut = leftOutName(leftOut);
        return row;
    }

    /// Springs by backward Euler, beside the rest of the default settings.
    Result<GpuBenchRow> measureBackward(std::uint32_t strands, runtime::LengthMethod lengths,
                                        const NamedLayout& layout) {
        runtime::SimulationSettings settings =
            settingsWithout(LeftOut::nothing, runtime::StrandModel::springs);
        settings.integrator = runtime::Integrator::implicitEuler;
        settings.lengthMethod = lengths;
        auto row = measure(turningHead(strands, kPoints, ActiveForces::windAndSpheres), settings, layout);
        if (!row) return row;
        const bool held = lengths == runtime::LengthMethod::constraint;
        row->hair = held ? "springs by backward Euler" : "coil springs by backward Euler";
        row->leftOut = leftOutName(LeftOut::nothing);
        for (const bool allThreads : {false, true}) {
            StepRun run(turningHead(strands, kPoints, ActiveForces::windAndSpheres), settings, allThreads);
            (allThreads ? row->cpuAll : row->cpuOne) = run.milliseconds(run.framesFor(seconds_));
        }
        return row;
    }

    Result<GpuBenchRow> measure(const Sample& sample) {
        auto strands = nodding(sample.groom);
        if (!strands) return tl::unexpected(strands.error());
        auto row = measure(std::move(*strands), sample.groom.simulation, layouts().front());
        if (!row) return row;
        row->hair = sample.name;
        row->leftOut = leftOutName(LeftOut::nothing);
        for (const bool allThreads : {false, true}) {
            auto again = nodding(sample.groom);
            if (!again) return tl::unexpected(again.error());
            StepRun run(std::move(*again), sample.groom.simulation, allThreads);
            (allThreads ? row->cpuAll : row->cpuOne) = run.milliseconds(run.framesFor(seconds_));
        }
        return row;
    }

    std::vector<NamedLayout> rodLayouts() const { return measuredRodLayouts(device_.info().type); }
    std::vector<NamedLayout> layouts() const { return measuredLayouts(device_.info().type); }

    double onCpu(std::uint32_t strands, bool allThreads) const {
        StepScene scene;
        scene.strands = strands;
        scene.allThreads = allThreads;
        StepRun run(scene);
        return run.milliseconds(run.framesFor(seconds_));
    }

  private:
    Result<GpuBenchRow> measure(std::unique_ptr<MovingStrands> strands,
                                const runtime::SimulationSettings& settings, const NamedLayout& layout) {
        auto run = GpuStepRun::make(device_, kernels_, std::move(strands), settings, layout.options);
        if (!run) return tl::unexpected(run.error());
        const auto frames = run->framesFor(seconds_);
        if (!frames) return tl::unexpected(frames.error());
        // While the kernel was made, in the first of these frames, the device rested.
        if (auto fast = bringToSpeed(device_, seconds_); !fast) return tl::unexpected(fast.error());
        const auto cost = run->cost(*frames);
        if (!cost) return tl::unexpected(cost.error());
        GpuBenchRow row;
        row.strands = run->engine().strandCount();
        row.points = run->engine().pointCount();
        row.substeps = settings.substeps;
        row.layout = layout.name;
        row.gpu = *cost;
        const double bytes = static_cast<double>(run->engine().frameBytes());
        row.bytes = bytes / run->work();
        const double milliseconds = cost->device > 0.0 ? cost->device : cost->wall;
        row.bandwidth = bytes * 1e-6 / milliseconds;
        return row;
    }

    gpu::Device& device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
    double seconds_;
};

Status measureSamples(Rows& rows, GpuBench& bench) {
    const auto& hair = samples();
    if (!hair) return tl::unexpected(hair.error());
    for (const Sample& sample : *hair) {
        auto row = rows.measure(sample);
        if (!row) return tl::unexpected(row.error());
        bench.samples.push_back(std::move(*row));
    }
    return {};
}

Status measureFigure(Rows& rows, const Extent& extent, GpuBench& bench) {
    std::vector<double> counts, gpu, one, all;
    for (const std::uint32_t strands : extent.strands) {
        auto row = rows.measure(strands, LeftOut::nothing, kRods, rows.layouts().front());
        if (!row) return tl::unexpected(row.error());
        bench.layouts.push_back(*row);
        row->cpuOne = rows.onCpu(strands, false);
        row->cpuAll = rows.onCpu(strands, true);
        counts.push_back(strands);
        gpu.push_back(row->gpu.wall);
        one.push_back(*row->cpuOne);
        all.push_back(*row->cpuAll);
        bench.rows.push_back(std::move(*row));
        for (const NamedLayout& layout : rows.rodLayouts()) {
            auto other = rows.measure(strands, LeftOut::nothing, kRods, layout);
            if (!other) return tl::unexpected(other.error());
            bench.layouts.push_back(std::move(*other));
        }
    }
    bench.crossesOne = crossing(counts, gpu, one);
    bench.crossesAll = crossing(counts, gpu, all);
    return {};
}

Status measureDetails(Rows& rows, const Extent& extent, GpuBench& bench) {
    const auto layouts = rows.layouts();
    for (const std::uint32_t strands : extent.details) {
        for (const LeftOut leftOut : kLeftOut) {
            auto row = rows.measure(strands, leftOut, kRods, layouts.front());
            if (!row) return tl::unexpected(row.error());
            bench.effects.push_back(std::move(*row));
        }
        for (const NamedLayout& layout : layouts) {
            auto row = rows.measure(strands, LeftOut::nothing, runtime::StrandModel::springs, layout);
            if (!row) return tl::unexpected(row.error());
            bench.layouts.push_back(std::move(*row));
        }
        for (const auto lengths : {runtime::LengthMethod::constraint, runtime::LengthMethod::springs}) {
            auto row = rows.measureBackward(strands, lengths, layouts.front());
            if (!row) return tl::unexpected(row.error());
            bench.backward.push_back(std::move(*row));
        }
    }
    return {};
}

Result<GpuBench> measureGpu(const Options& options, bool figureAlone) {
    const Extent extent = extentOf(options);
    gpu::DeviceOptions wanted;
    wanted.backend = gpu::Backend::Vulkan;
    wanted.index = options.device;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    const gpu::DeviceInfo& info = (*device)->info();
    GpuBench bench;
    bench.device = info.name;
    bench.driver = info.driver;
    bench.date =
        fmt::format("{:%Y-%m-%d}", std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
    bench.machine = thisMachine();
    const auto bandwidth = copyBandwidth(**device);
    if (!bandwidth) return tl::unexpected(bandwidth.error());
    bench.copyBandwidth = *bandwidth;
    Rows rows(**device, extent.seconds);
    if (!figureAlone) {
        if (auto status = measureSamples(rows, bench); !status) return tl::unexpected(status.error());
    }
    if (auto status = measureFigure(rows, extent, bench); !status) return tl::unexpected(status.error());
    if (figureAlone) return bench;
    if (auto status = measureDetails(rows, extent, bench); !status) return tl::unexpected(status.error());
    return bench;
}

Result<Outcome> runGpuSim(const Options& options) {
    const auto bench = measureGpu(options, false);
    if (!bench) return tl::unexpected(bench.error());
    return Outcome{reportOf(*bench),
                   {},
                   {{"gpu-sim.csv", csvOf(*bench)},
                    {"gpu-sim.md", markdownOf(*bench, options.commandLine)},
                    {"figure-27.svg", figureOf(*bench)}}};
}

}  // namespace

Result<GpuBench> measureFigure27(const Options& options) {
    return measureGpu(options, true);
}

Benchmark gpuSimBenchmark() {
    return {"gpu-sim",
            "the strand engine on a GPU beside this CPU",
            {"--strands", "--quick", "--device", "--output"},
            runGpuSim};
}

}  // namespace hairloom::benchmarks
