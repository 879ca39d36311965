// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "cli/card_options.h"
#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "core/base/log.h"
#include "core/base/stopwatch.h"
#include "core/levels/level_report.h"
#include "core/levels/spring_fit.h"
#include "exporters/card_character.h"

namespace hairloom::cli {
namespace {

struct LodOptions {
    std::string input;
    std::string output;
    LevelBudget budget;
};

Result<Report> run(const LodOptions& options, const std::string& commandLine) {
    const Stopwatch watch;
    const auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    Progress bar("creating levels", 1000);
    const auto chain = makeLevels(
        *groom, options.budget, LevelsMade::all,
        [&](std::string_view, double share) { bar.done(static_cast<std::size_t>(1000 * share)); }, nullptr);
    if (!chain) return tl::unexpected(inFile(chain.error(), options.input));
    std::vector<Finding> findings;
    const cards::Character character = cardCharacter({*groom, chain->roots_ws}, findings);
    tellFindings(findings);
    const auto files = writeChain(*chain, commandLine, collidersOf(*groom), character, options.output);
    if (!files) return tl::unexpected(files.error());
    Report report{{"hairs", chain->strands},
                  {"directions", chain->views.size()},
                  {"measured_directions", 2 * chain->views.size()}};
    report["levels"] = Report::array();
    for (const cards::Level& level : chain->levels) report["levels"].push_back(toJson(level));
    report["largest_light_step"] = std::ranges::max(cards::lightSteps(chain->levels));
    for (const cards::Level& level : chain->levels) {
        const std::string fails = failureWords(level);
        if (!fails.empty()) log::warning("{} fails: {}", level.name, fails);
    }
    const IdleCardEdits idle = idleCardEdits(*chain, *groom);
    report["lost_card_edits"] = idle.lost;
    report["unmade_card_edits"] = idle.unmade;
    report["springs"] = chain->springFit ? toJson(*chain->springFit) : Report();
    report["make_seconds"] = chain->makeSeconds;
    report["seconds"] = watch.seconds();
    report["output"] = options.output;
    report["files"] = *files;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<LodOptions>();
    job.add_option("groom", options->input, "Groom to create levels of")->required();
    job.add_option("-o,--output", options->output,
                   "Folder for textures, meshes, comparison images, table and plot")
        ->required();
    addCardOptions(job, options->budget);
    job.add_option("--directions", options->budget.chain.directions,
                   "Number of directions from which levels are compared")
        ->check(CLI::Range(1, 360));
    return [options](const std::string& commandLine) {
        checkLevels(options->budget);
        return withOutputFolder(
            options->output,
            {"report.html", "levels.csv", "levels.md", "levels.json", "error.svg", "chain.png", "levels.glb"},
            [&] { return run(*options, commandLine); });
    };
}

}  // namespace

Job lodJob() {
    return {"lod", "Create levels of detail: strands, cards and a shell",
            "hair.hairloom -o levels --cards 200 --json", declare};
}

}  // namespace hairloom::cli
