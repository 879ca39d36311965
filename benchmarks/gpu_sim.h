// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `bench gpu-sim`: the strand engine on a GPU beside the one on this CPU. The thesis' Figure 27 (Rünz 2012,
// Section 7.2) again, with what each effect and each layout costs.

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/benchmark.h"
#include "core/cost/gpu_cost.h"
#include "core/cost/machine.h"

namespace hairloom::benchmarks {

struct GpuBenchRow {
    std::string hair;  ///< a sample's name, or rods or springs of the made-up head
    std::uint32_t strands = 0;
    std::uint32_t points = 0;  ///< of all strands
    std::uint32_t substeps = 0;
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
    double copyBandwidth = 0;  ///< GB/s
    std::vector<GpuBenchRow> samples;
    std::vector<GpuBenchRow> rows;      ///< Figure 27: rods, every effect
    std::vector<GpuBenchRow> effects;   ///< rods
    std::vector<GpuBenchRow> layouts;   ///< rods, then springs in each layout
    std::vector<GpuBenchRow> backward;  ///< springs by backward Euler, with held lengths and as coils
    std::optional<double> crossesOne,
        crossesAll;  ///< strands from which the GPU is faster than one, all threads
};

/// The rows of Figure 27 alone, of Options::strands. Error: there is no GPU, or it fails.
Result<GpuBench> measureFigure27(const Options& options);

Report reportOf(const GpuBench& bench);
std::string csvOf(const GpuBench& bench);
std::string markdownOf(const GpuBench& bench, const std::string& command);
std::string figureOf(const GpuBench& bench);

}  // namespace hairloom::benchmarks
