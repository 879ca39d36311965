// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `bench shadows`: how far shadow maps of hair are from fibres counted on the CPU, by kind, layers and
// resolution; and those of the head on hair from rays.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/measurements.h"

namespace hairloom::cli {

struct ShadowBenchOptions {
    std::optional<std::uint32_t> device;
    bool quick = false;  ///< fewer points and resolutions
};

struct ShadowRow {
    std::string name;
    std::vector<double> errors;  ///< root mean square of the transmittance, by resolution
};

struct ShadowBench {
    std::string device;
    std::size_t hairs = 0, points = 0;
    double fibres = 0;  ///< mean of those counted
    std::vector<std::uint32_t> resolutions;
    std::vector<ShadowRow> rows;
    double visible = 0;               ///< share of the points that the head does not shade
    std::vector<ShadowRow> headRows;  ///< of the head's shadow on hair
};

Result<ShadowBench> runShadowBench(const ShadowBenchOptions& options);
Report reportOf(const ShadowBench& bench);
std::string markdownOf(const ShadowBench& bench, const std::string& command);
/// Error against resolution, as SVG.
std::string figureOf(const ShadowBench& bench);

}  // namespace hairloom::cli
