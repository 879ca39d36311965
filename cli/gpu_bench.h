// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `bench gpu-sim`: the strand engine on a GPU beside the one on this CPU. The thesis' Figure 27 (Rünz 2012,
// Section 7.2) again, with what each effect and each layout costs.

#include <optional>
#include <string>
#include <vector>

#include "cli/job.h"
#include "core/accuracy/gpu_cost.h"
#include "core/accuracy/machine.h"

namespace hairloom::cli {

struct GpuBenchOptions {
    std::vector<std::uint32_t> strands{100, 200, 300, 1'000, 3'000, 10'000, 30'000, 100'000};
    /// Numbers of strands at which effects and layouts are told apart.
    std::vector<std::uint32_t> details{300, 10'000, 100'000};
    double seconds = 0.2;  ///< of one measurement, about
    bool cpu = true;
    std::optional<std::uint32_t> device;
};

struct GpuBenchRow {
    std::uint32_t strands = 0;
    std::string leftOut;  ///< an effect, or "nothing"
    std::string layout;
    GpuFrameCost gpu;
    std::optional<double> cpuOne, cpuAll;  ///< milliseconds
    double bytes = 0;      ///< that a frame reads and writes of what changes, per particle and substep
    double bandwidth = 0;  ///< GB/s of them
};

struct GpuBench {
    std::string device, driver, date;
    Machine machine;
    double copyBandwidth = 0;       ///< GB/s
    std::vector<GpuBenchRow> rows;  ///< Figure 27: every effect, the first layout
    std::vector<GpuBenchRow> effects, layouts;
    std::optional<double> crossesOne,
        crossesAll;  ///< strands from which the GPU is faster than one, all threads
};

Result<GpuBench> runGpuBench(const GpuBenchOptions& options);

Report reportOf(const GpuBench& bench);
std::string csvOf(const GpuBench& bench);
std::string markdownOf(const GpuBench& bench, const std::string& command);
std::string figureOf(const GpuBench& bench);

}  // namespace hairloom::cli
