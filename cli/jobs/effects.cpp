// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <optional>

#include "cli/accuracy_jobs.h"
#include "cli/documents.h"
#include "cli/job.h"
#include "cli/motions.h"
#include "cli/progress.h"
#include "core/cost/effect_cost.h"

namespace hairloom::cli {
namespace {

struct EffectsOptions {
    MotionOptions motion;
    std::uint32_t repeats = 5;
};

/// "ms_on" is the frame with the effect, "ms_off" without it; one of them is null where it was not run.
Report effectRow(const EffectCosts& costs, const EffectCost& effect) {
    Report row;
    row["name"] = effect.name;
    row["on"] = effect.on;
    row["why"] = effect.why;
    const double asItIs = costs.milliseconds.median;
    const Report without = effect.millisecondsOff ? Report(effect.millisecondsOff->median) : Report();
    row["ms_on"] = effect.on ? Report(asItIs) : Report();
    row["ms_off"] = effect.on ? without : Report(asItIs);
    const auto& cost = effect.costMilliseconds;
    const auto price = effect.price();
    row["ms"] = price ? Report(*price) : Report();
    row["ms_cost_q1"] = cost ? Report(cost->q1) : Report();
    row["ms_cost_q3"] = cost ? Report(cost->q3) : Report();
    row["ms_stages"] = effect.stageMilliseconds;
    row["bytes"] = effect.bytes;
    row["turned_off_by"] = effect.turnedOffBy;
    row["note"] = effect.note;
    return row;
}

Result<Report> effects(const EffectsOptions& options) {
    const auto scene = openMovingGroom(options.motion);
    if (!scene) return tl::unexpected(scene.error());
    EffectCostOptions measuring;
    measuring.time.frames = options.motion.frames;
    measuring.time.framesPerSecond = options.motion.framesPerSecond;
    measuring.repeats = options.repeats;
    std::optional<Progress> progress;
    measuring.progress = [&](std::size_t done, std::size_t total) {
        if (!progress) progress.emplace("measuring", total);
        progress->done(done);
    };
    const auto costs = measureEffectCosts(scene->groom, *scene->motion, measuring);
    progress.reset();
    if (!costs) return tl::unexpected(costs.error());

    Report report;
    report["strands"] = scene->groom.strandCount();
    report["points"] = scene->groom.pointCount();
    report["frames"] = measuring.time.frames;
    report["runs"] = measuring.repeats;
    report["ms_per_frame"] = toReport(costs->milliseconds);
    report["effects"] = Report::array();
    for (const EffectCost& effect : costs->effects) report["effects"].push_back(effectRow(*costs, effect));
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<EffectsOptions>();
    addMotionOptions(job, options->motion);
    job.add_option("--repeat", options->repeats, "Timed runs with and without each effect")
        ->check(CLI::Range(1, 1000));
    return [options](const std::string&) { return effects(*options); };
}

}  // namespace

Job effectsJob() {
    return {"effects", "Report which effects the scene runs, why, and what each costs",
            "hair.hairloom --motion nod --wind 3,0,1", declare};
}

}  // namespace hairloom::cli
