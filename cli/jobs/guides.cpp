// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <memory>
#include <vector>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "core/base/content_kind.h"
#include "core/base/stopwatch.h"
#include "core/groom/file/project_file.h"
#include "core/operations/guide_clusters.h"

namespace hairloom::cli {
namespace {

struct GuidesOptions {
    std::string input, output;
    GuidesSettings settings;
    bool all = false;
};

Result<Report> run(const GuidesOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    const Stopwatch watch;
    GuidesSettings settings = options.settings;
    settings.alone = !options.all;
    const std::vector<std::uint32_t> strands = strandsToEdit(*groom, {});
    Progress bar("clustering", 1000);
    const GuideClusters clusters = clusterGuides(
        *groom, strands, settings, [&](double share) { bar.done(static_cast<std::size_t>(1000 * share)); });
    if (clusters.guides.empty())
        return failIn(options.input, {}, "no strand can be a guide",
                      "expected strands of at least two points that are not frozen or locked");
    Report report{{"strands", groom->strandCount()},
                  {"guides", clusters.guides.size()},
                  {"mean_mm", clusters.meanMm},
                  {"max_mm", clusters.maxMm}};
    if (!options.output.empty()) {
        keepGuides(*groom, strands, clusters, settings.alone);
        if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
        report["output"] = options.output;
    }
    report["follow_per_guide"] = groom->interpolation.followPerGuide;
    report["seconds"] = watch.seconds();
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<GuidesOptions>();
    job.add_option("groom", options->input, "Groom with many strands")->required();
    job.add_option("--count", options->settings.count, "Number of guides")->check(CLI::Range(1, 100'000));
    job.add_option("--root-weight", options->settings.rootWeight,
                   "Weight of the distance between roots, relative to the difference in shape")
        ->check(CLI::Range(0.0, 100.0));
    job.add_option("--seed", options->settings.seed, "Random seed of the clusters");
    job.add_flag("--all", options->all,
                 "Keep all strands and mark the guides. Otherwise only guides stay, with follow hairs");
    job.add_option("-o,--output", options->output,
                   "Project to write. Without it, the job only reports the error");
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return run(*options); });
    };
}

}  // namespace

Job guidesJob() {
    return {"guides", "Reduce strands to a few guides by clustering",
            "hair.hairloom --count 200 -o guides.hairloom", declare};
}

}  // namespace hairloom::cli
