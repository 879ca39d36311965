// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the jobs of core/accuracy have in common.

#include <CLI/App.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "cli/job.h"
#include "core/accuracy/ground_truth.h"
#include "core/cost/statistics.h"

namespace hairloom::cli {

struct GroundTruthOptions {
    std::string groundTruth = "reference";
    std::uint32_t strands = 16;
    std::uint32_t substeps = 64;
    double toleranceMm = 0.01;
};
/// --truth, --truth-strands, --truth-tolerance, --truth-substeps.
void addGroundTruthOptions(CLI::App& job, GroundTruthOptions& options);
std::unique_ptr<GroundTruthSource> makeGroundTruth(const GroundTruthOptions& options);

/// median, q1, q3.
Report toReport(const Quartiles& times);

}  // namespace hairloom::cli
