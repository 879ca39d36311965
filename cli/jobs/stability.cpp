// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/backend.h"
#include "cli/certificate_report.h"
#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/stability/certificate.h"
#include "core/stability/stability_report.h"
#include "core/stability/stable_steps.h"

namespace hairloom::cli {
namespace {

struct StabilityJobOptions {
    std::string groom;  ///< empty: the hard cases
    std::string output;
    std::vector<std::string> integrators;
    std::uint32_t cells = 24;
    std::uint32_t steps = 2000;
    std::uint64_t stepsAtRest = StabilityOptions{}.stepsAtRest;
    std::optional<std::uint32_t> storms;
    std::optional<std::uint32_t> firstStorm;
    std::string backend = "cpu";
    std::optional<std::uint32_t> device;
};

std::vector<StabilityMethod> chosenMethods(const std::vector<std::string>& names) {
    std::vector<StabilityMethod> chosen;
    for (const StabilityMethod& method : allStabilityMethods()) {
        if (names.empty() || std::ranges::find(names, method.name()) != names.end()) chosen.push_back(method);
    }
    return chosen;
}
std::vector<std::string> methodNames() {
    std::vector<std::string> names;
    for (const StabilityMethod& method : allStabilityMethods()) names.push_back(method.name());
    return names;
}

Report numberOrNull(double value) {
    return std::isfinite(value) ? Report(value) : Report();
}

Report caseReport(const StabilityResult& result) {
    const StabilityThreshold& m = result.closest();
    Report row;
    row["number"] = result.number;
    row["name"] = result.name;
    row["integrator"] = result.integrator;
    row["substeps"] = result.substeps;
    row["claimed"] = result.claimed;
    row["pass"] = result.pass;
    row["measured"] = m.what;
    row["worst"] = numberOrNull(m.worst);
    row["threshold"] = m.threshold;
    row["mark"] = m.threshold;  // as it was called before
    row["unit"] = m.unit;
    row["failed_at"] = result.failedAt ? Report(*result.failedAt) : Report();
    row["limit"] = result.limit;
    return row;
}

Report mapReport(const StabilityMap& map) {
    Report row;
    row["integrator"] = nameOf(map.integrator);
    row["force"] = forceName(map.force);
    row["stable"] = std::ranges::count_if(map.probes, &StabilityProbe::stable);
    row["cells"] = map.probes.size();
    row["limit"] = numberOrNull(map.limit);
    row["surprises"] = map.surprises;
    return row;
}

Result<Report> stability(const StabilityJobOptions& options, const std::string& commandLine) {
    std::vector<StabilityMethod> methods = chosenMethods(options.integrators);
    StabilityOptions suite;
    std::unique_ptr<GpuBackend> gpu;
    if (options.backend == "vulkan") {
        auto made = GpuBackend::make(gpu::Backend::Vulkan, options.device);
        if (!made) return tl::unexpected(made.error());
        gpu = std::move(*made);
        suite.engines = gpuHardCaseEngines(gpu->device(), gpu->kernels());
    }
    suite.stepsAtRest = options.stepsAtRest;
    suite.storms = options.storms.value_or(suite.storms);
    const std::vector<StabilityResult> results = runHardCases(methods, suite);
    std::vector<StabilityMap> maps;
    // Maps are of the integrators, not of what runs them.
    for (const MappedForce force : {MappedForce::coils, MappedForce::angular}) {
        if (gpu) break;
        for (const StabilityMethod& method : methods) {
            if (!method.rods())
                maps.push_back(mapStability(method.integrator, force, options.cells, options.steps));
        }
    }
    const auto files = writeStability(results, maps, commandLine, options.output);
    if (!files) return tl::unexpected(files.error());

    Report report;
    report["failed"] =
        std::ranges::count_if(results, [](const StabilityResult& r) { return r.claimed && !r.pass; });
    report["cases"] = Report::array();
    for (const StabilityResult& result : results) report["cases"].push_back(caseReport(result));
    report["maps"] = Report::array();
    for (const StabilityMap& map : maps) report["maps"].push_back(mapReport(map));
    report["output"] = options.output;
    report["files"] = *files;
    report["files"].push_back("cases.json");
    const std::filesystem::path path = std::filesystem::path(options.output) / "cases.json";
    if (auto status = writeFileAtomically(path, report["cases"].dump(2) + "\n"); !status)
        return tl::unexpected(status.error());
    return report;
}

/// What one hairstyle withstands.
Result<Report> certified(const StabilityJobOptions& options) {
    const auto groom = openGroom(options.groom);
    if (!groom) return tl::unexpected(groom.error());
    CertificateOptions storms;
    storms.storms = options.storms.value_or(storms.storms);
    storms.first = options.firstStorm.value_or(0);
    Progress progress("storms", storms.storms);
    storms.progress = [&](std::size_t done, std::size_t) { progress.done(done); };
    const auto tally = runStorms(*groom, storms);
    if (!tally) return tl::unexpected(inFile(tally.error(), options.groom));
    Report report;
    if (options.firstStorm) {
        report["tally"] = toReport(*tally);
        report["output"] = options.output;
        const auto files = writeFiles(options.output, {{"storms.json", report["tally"].dump(2) + "\n"}});
        if (!files) return tl::unexpected(files.error());
        report["files"] = *files;
        return report;
    }
    const auto certificate = certificateOf({*tally});
    if (!certificate) return tl::unexpected(inFile(certificate.error(), options.groom));
    report["certificate"] = toReport(*certificate);
    report["steps"] = Report::array();
    for (const StableStep& step : stableSteps(*groom)) {
        report["steps"].push_back(Report{{"method", step.method},
                                         {"longest_stable_ms", numberOrNull(1e3 * step.longest)},
                                         {"now", step.isOfGroom}});
    }
    report["output"] = options.output;
    const auto files =
        writeFiles(options.output, {{"certificate.json", report["certificate"].dump(2) + "\n"}});
    if (!files) return tl::unexpected(files.error());
    report["files"] = *files;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<StabilityJobOptions>();
    CLI::Option* const groom = job.add_option("groom", options->groom, "Groom to certify with random storms");
    job.add_option(
           "-o,--output", options->output,
           "Folder for report.html, cases.json, cases.csv, cases.md and the maps, or for certificate.json "
           "or storms.json")
        ->required();
    job.add_option("--integrators", options->integrators,
                   "Models to run instead of all: rods, or integrators of springs")
        ->delimiter(',')
        ->check(CLI::IsMember(methodNames()))
        ->excludes(groom);
    job.add_option("--storms", options->storms,
                   "Number of random storms of case 26, or on the groom (default: 1,000)")
        ->check(CLI::Range(1, 1'000'000));
    job.add_option("--first-storm", options->firstStorm,
                   "With a groom: number of the first storm. Writes storms.json, the part of a certificate "
                   "that `sweep` joins with the others")
        ->check(CLI::Range(0, 1'000'000))
        ->needs(groom);
    job.add_option("--backend", options->backend, "Device that runs the cases. Maps are made only on the CPU")
        ->check(CLI::IsMember({"cpu", "vulkan"}))
        ->excludes(groom);
    job.add_option("--device", options->device, "GPU to use, by its index in `devices`");
    job.add_option("--cells", options->cells, "Number of steps and stiffnesses in a map")
        ->check(CLI::Range(2, 200));
    job.add_option("--steps", options->steps, "Steps per cell")->check(CLI::Range(40, 100'000));
    job.add_option("--steps-at-rest", options->stepsAtRest, "Substeps of the case at rest")
        ->check(CLI::Range(8, 100'000'000));
    return [options](const std::string& commandLine) {
        return withOutputFolder(
            options->output,
            options->groom.empty()
                ? std::vector<std::string>{"report.html", "cases.json", "cases.csv", "cases.md"}
                : std::vector<std::string>{options->firstStorm ? "storms.json" : "certificate.json"},
            [&] { return options->groom.empty() ? stability(*options, commandLine) : certified(*options); });
    };
}

}  // namespace

Job stabilityJob() {
    return {"stability", "Run hard cases and map stable steps, or certify a groom",
            "-o stability --integrators verlet,rk4", declare};
}

}  // namespace hairloom::cli
