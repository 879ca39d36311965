// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/accuracy_jobs.h"

namespace hairloom::cli {

void addGroundTruthOptions(CLI::App& job, GroundTruthOptions& options) {
    job.add_option("--truth", options.groundTruth,
                   "What counts as true: the reference in double precision, or the engine converged")
        ->check(CLI::IsMember({"reference", "engine"}));
    job.add_option("--truth-strands", options.strands,
                   "Strands that errors are taken from when the reference is true; it is slow")
        ->check(CLI::Range(1, 100'000));
    job.add_option("--truth-tolerance", options.toleranceMm,
                   "Millimetres by which a doubling of the reference's steps may still move a point")
        ->check(CLI::Range(1e-6, 10.0));
    job.add_option("--truth-substeps", options.substeps,
                   "Most steps, in each quarter of a frame, of the run that counts as true")
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
