// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "cli/accuracy_jobs.h"
#include "cli/documents.h"
#include "cli/job.h"
#include "cli/motions.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "core/accuracy/budget.h"
#include "core/base/content_kind.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/settings_json.h"

namespace hairloom::cli {
namespace {

struct BudgetJobOptions {
    MotionOptions motion;
    double milliseconds = 1;
    std::uint32_t characters = 1;
    std::string output;
    std::uint32_t strands = 100;
    std::uint32_t repeats = 5;
    GroundTruthOptions groundTruth;
    std::uint64_t seed = 1;
};

/// Share by which times of the same may differ where they are to be relied upon.
constexpr double kSteady = 0.15;

/// A bar for each thing that is done.
class Bars {
  public:
    void show(const std::string& what, std::size_t done, std::size_t total) {
        if (!bar_ || what != what_ || total != total_) bar_.emplace(what, total);
        what_ = what;
        total_ = total;
        bar_->done(done);
    }

  private:
    std::optional<Progress> bar_;
    std::string what_;
    std::size_t total_ = 0;
};

Result<Report> budget(const BudgetJobOptions& options) {
    const auto scene = openMovingGroom(options.motion);
    if (!scene) return tl::unexpected(scene.error());
    BudgetOptions solving;
    // Characters are stepped one after the other, each on all threads.
    const double characters = options.characters;
    solving.milliseconds = options.milliseconds / characters;
    solving.time.frames = options.motion.frames;
    solving.time.framesPerSecond = options.motion.framesPerSecond;
    solving.strands = options.strands;
    solving.repeats = options.repeats;
    solving.seed = options.seed;
    std::optional<Bars> bars(std::in_place);
    solving.progress = [&](const std::string& what, std::size_t done, std::size_t total) {
        bars->show(what, done, total);
    };
    const auto solved =
        solveBudget(scene->groom, *scene->motion, solving, *makeGroundTruth(options.groundTruth));
    bars.reset();
    if (!solved) return tl::unexpected(solved.error());
    if (!solved->fits) {
        return failIn(
            options.motion.input, {},
            fmt::format("the fastest settings found take {:.3g} ms a frame on this machine",
                        characters * solved->milliseconds.median),
            fmt::format("a budget of at least that; {:.3g} ms were asked for, {:.3g} ms is what the "
                        "scene takes as it is",
                        options.milliseconds, characters * solved->authoredMilliseconds.median));
    }
    Report report;
    report["settings"] = toJson(solved->groom.simulation);
    report["points"] = solved->groom.pointCount();
    const Quartiles& one = solved->milliseconds;
    const double spread = (one.q3 - one.q1) / one.median;
    report["characters"] = options.characters;
    report["ms"] = characters * one.median;
    report["ms_again"] = characters * solved->millisecondsAgain;
    report["ms_spread"] =
        toReport(Quartiles{characters * one.q1, characters * one.median, characters * one.q3});
    report["spread_share"] = spread;
    report["ms_as_authored"] = characters * solved->authoredMilliseconds.median;
    report["error_mm"] = solved->errorMm;
    report["error_mm_max"] = solved->errorMaxMm;
    report["given_up"] = Report::array();
    for (const GivenUp& thing : solved->givenUp)
        report["given_up"].push_back(Report{{"what", thing.what}, {"from", thing.from}, {"to", thing.to}});
    report["notes"] = solved->notes;
    if (!(spread <= kSteady) || !(std::abs(solved->millisecondsAgain / one.median - 1) <= kSteady)) {
        report["notes"].push_back(fmt::format(
            "This machine was busy: half of the runs differ by {:.0f} %, and the choice took {:.3g} ms "
            "when it ran again. Measure on a quiet one before you rely on it.",
            100 * spread, characters * solved->millisecondsAgain));
    }
    if (options.output.empty()) return report;
    if (auto saved = saveProject(solved->groom, options.output); !saved) return tl::unexpected(saved.error());
    report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<BudgetJobOptions>();
    addMotionOptions(job, options->motion);
    job.add_option("--ms", options->milliseconds, "Milliseconds a frame for the engine and all strands")
        ->required()
        ->check(CLI::Range(1e-6, 1e6));
    job.add_option("--characters", options->characters,
                   "Characters with this hair that share the milliseconds, one after the other")
        ->check(CLI::Range(1, 100'000));
    job.add_option("-o,--output", options->output, "Project to save with what was found");
    job.add_option("--strands", options->strands,
                   "Strands that errors are taken from, drawn from the groom's")
        ->check(CLI::Range(1, 1'000'000));
    job.add_option("--repeat", options->repeats, "Timed runs of each candidate")->check(CLI::Range(1, 1000));
    addGroundTruthOptions(job, options->groundTruth);
    job.add_option("--seed", options->seed, "Another seed draws other strands");
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return budget(*options); });
    };
}

}  // namespace

Job budgetJob() {
    return {"budget", "Find the most exact settings that cost at most so many milliseconds a frame here",
            "hair.hairloom --ms 0.5 --motion nod --wind 3,0,1 -o fast.hairloom", declare};
}

}  // namespace hairloom::cli
