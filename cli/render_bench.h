// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `bench render`: what drawing hair costs on a device, with what is changed one at a time.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/measurements.h"
#include "core/gpu/device.h"
#include "core/render/fibre_material.h"
#include "core/render/options.h"

namespace hairloom::cli {

struct RenderBenchOptions {
    std::vector<std::uint32_t>
        hairs;  ///< empty: those of the thesis' Table 3 and a whole head, fewer without a GPU
    std::optional<std::pair<std::uint32_t, std::uint32_t>>
        size;  ///< empty: 1920 × 1080, smaller without a GPU
    int repetitions = 20;
    std::optional<std::uint32_t> device;
};

/// One way of drawing one scene. Each frame has other positions, so that every pass runs.
struct RenderCase {
    std::string name;
    std::uint32_t hairs = 0;
    render::FibreMaterial shading;  ///< that of Marschner, single scattering, unless the name says otherwise
    render::RenderOptions options;
    bool sky = false;   ///< light from around as well
    Measurement frame;  ///< all passes on the device, ms; wall time where it has no clock
    Measurement wall;   ///< from recording to the end on the device, ms, with the upload of positions
    std::vector<Measurement> passes;  ///< ms
    std::uint64_t targetBytes = 0;
    std::optional<double> limit;  ///< ms that the frame may take, where that is laid down for this device

    bool met() const { return !limit || frame.median() <= *limit; }
};

struct RenderBench {
    gpu::DeviceInfo device;
    std::vector<RenderCase> cases;
    std::vector<std::string> notes;  ///< what could not be measured, and why
};

inline constexpr std::uint32_t kBenchSegments = 18;

Result<RenderBench> runRenderBench(const RenderBenchOptions& options);
Report reportOf(const RenderBench& bench);
/// The tables as Markdown; `command` is how they were made.
std::string markdownOf(const RenderBench& bench, const std::string& command);

}  // namespace hairloom::cli
