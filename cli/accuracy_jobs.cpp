// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/accuracy_jobs.h"

namespace hairloom::cli {

void addGroundTruthOptions(CLI::App& job, GroundTruthOptions& options) {
    job.add_option("--truth", options.groundTruth,
                   "What counts as exact: the reference in double precision, or the converged engine")
        ->check(CLI::IsMember({"reference", "engine"}));
    job.add_option("--truth-strands", options.strands,
                   "Number of strands for the error when --truth is reference, which is slow")
        ->check(CLI::Range(1, 100'000));
    job.add_option("--truth-tolerance", options.toleranceMm,
                   "Largest change of a point in millimetres when the steps of the reference are doubled")
        ->check(CLI::Range(1e-6, 10.0));
    job.add_option("--truth-substeps", options.substeps,
                   "Maximum steps of the exact run, in each quarter of a frame")
        ->check(CLI::IsMember({8, 16, 32, 64}));
}

std::unique_ptr<GroundTruthSource> makeGroundTruth(const GroundTruthOptions& options) {
    if (options.groundTruth == "engine") return std::make_unique<EngineConverged>(options.substeps);
    return std::make_unique<ReferenceConverged>(
        ReferenceConverged::Options{options.strands, options.toleranceMm, options.substeps});
}

Report toReport(const Quartiles& times) {
    return Report{{"median", times.median}, {"q1", times.q1}, {"q3", times.q3}};
}

}  // namespace hairloom::cli
