// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/accuracy_jobs.h"
#include "cli/backend.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/motions.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/vectors.h"
#include "core/accuracy/budget.h"
#include "core/base/content_kind.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/settings_json.h"
#include "core/live/live_cost.h"

namespace hairloom::cli {
namespace {

struct BudgetJobOptions {
    MotionOptions motion;
    std::optional<double> milliseconds, withinMm;  // one of them
    std::uint32_t characters = 1;
    std::optional<std::uint32_t> device;  ///< whole frames on that GPU; else the engine on the CPU
    std::string size;                     ///< of those frames
    bool busy = false;                    ///< times need not be reliable
    std::string output;
    std::uint32_t strands = 100;
    std::uint32_t repeats = 5;
    // What decides is which setting is the better one: the engine converged tells that in seconds.
    GroundTruthOptions groundTruth{.groundTruth = "engine"};
    std::uint64_t seed = 1;
};

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

/// Whole frames on a GPU, simulated and drawn as the viewport does while something moves.
class FrameTimer {
  public:
    static Result<FrameTimer> make(std::uint32_t device, const std::string& size, const HeadMotion& motion) {
        std::pair<std::uint32_t, std::uint32_t> pixels(1920, 1080);
        if (!size.empty()) pixels = orWrongUsage(parseSize(size));
        auto gpu = GpuBackend::make(std::nullopt, device);
        if (!gpu) return tl::unexpected(gpu.error());
        return FrameTimer(std::move(*gpu), pixels, motion);
    }
    Result<double> time(const Groom& groom) {
        constexpr std::uint32_t kFrames = 60, kFramesOfSoftware = 4;
        const bool software = gpu_->device().info().type == gpu::DeviceType::Cpu;
        const auto cost = loop_->run(groom, motion_, EngineKind::gpu, software ? kFramesOfSoftware : kFrames);
        if (!cost) return tl::unexpected(cost.error());
        last_ = *cost;
        return cost->frame();
    }
    const std::string& deviceName() const { return gpu_->deviceName(); }
    /// Of the frames timed last, which are those of the choice.
    Report parts() const {
        return Report{{"hairs", last_.hairs},      {"simulate_ms", last_.simulate},
                      {"follow_ms", last_.follow}, {"shadow_ms", last_.shadow},
                      {"shade_ms", last_.shade},   {"draw_ms", last_.draw},
                      {"frame_ms", last_.frame()}};
    }

  private:
    FrameTimer(std::unique_ptr<GpuBackend> gpu, std::pair<std::uint32_t, std::uint32_t> pixels,
               const HeadMotion& motion)
        : gpu_(std::move(gpu)),
          loop_(std::make_unique<LiveLoop>(gpu_->device(), gpu_->kernels(), pixels.first, pixels.second)),
          motion_(motion) {}

    std::unique_ptr<GpuBackend> gpu_;
    std::unique_ptr<LiveLoop> loop_;
    const HeadMotion& motion_;
    LiveCost last_;
};

Error doesNotFit(const BudgetJobOptions& options, const Budget& solved) {
    if (options.withinMm) {
        return Error{
            options.motion.input,
            {},
            fmt::format("the most accurate settings found have an error of {:.3g} mm", solved.errorMm),
            fmt::format("allow at least that: {:.3g} mm was the limit", *options.withinMm)};
    }
    const double characters = options.characters;
    return Error{
        options.motion.input,
        {},
        fmt::format("the fastest settings found take {:.3g} ms per frame on this machine",
                    characters * solved.milliseconds.median),
        fmt::format("allow at least that: {:.3g} ms was the limit, and the scene takes {:.3g} ms as authored",
                    *options.milliseconds, characters * solved.authoredMilliseconds.median)};
}

Error isTooBusy(const BudgetJobOptions& options, const Budget& solved) {
    const Quartiles& ms = solved.milliseconds;
    return Error{
        options.motion.input,
        {},
        fmt::format("this machine is too busy to measure milliseconds: the middle half of the runs of the "
                    "chosen settings differ by {:.0f} %, and they took {:.3g} ms, then {:.3g} ms",
                    100 * (ms.q3 - ms.q1) / ms.median, options.characters * ms.median,
                    options.characters * solved.millisecondsAgain),
        fmt::format("expected differences of at most {:.0f} %: use a quiet machine, more --repeat, or --busy "
                    "to accept them",
                    100 * kSteadyShare)};
}

Result<Report> budget(const BudgetJobOptions& options) {
    const auto scene = openMovingGroom(options.motion);
    if (!scene) return tl::unexpected(scene.error());
    BudgetOptions solving;
    // Characters are stepped one after the other, each on all threads.
    const double characters = options.characters;
    if (options.milliseconds) solving.milliseconds = *options.milliseconds / characters;
    solving.withinMm = options.withinMm;
    std::optional<FrameTimer> frames;
    if (options.device) {
        auto made = FrameTimer::make(*options.device, options.size, *scene->motion);
        if (!made) return tl::unexpected(made.error());
        frames.emplace(std::move(*made));
        solving.frameTime = [&](const Groom& groom) { return frames->time(groom); };
    }
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
    if (!solved->fits) return tl::unexpected(doesNotFit(options, *solved));
    if (solved->busy() && !options.busy) return tl::unexpected(isTooBusy(options, *solved));
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
    if (frames) report["device"] = frames->deviceName();
    if (frames) report["frame"] = frames->parts();
    if (solved->busy()) report["notes"].push_back(isTooBusy(options, *solved).message());
    if (options.output.empty()) return report;
    if (auto saved = saveProject(solved->groom, options.output); !saved) return tl::unexpected(saved.error());
    report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<BudgetJobOptions>();
    addMotionOptions(job, options->motion);
    auto* asked = job.add_option_group("the limit");
    asked
        ->add_option(
            "--ms", options->milliseconds,
            "Milliseconds per frame for all strands: finds the most accurate settings within this time")
        ->check(CLI::Range(1e-6, 1e6));
    asked
        ->add_option("--within-mm", options->withinMm,
                     "Root mean square error in millimetres: finds the fastest settings within this error")
        ->check(CLI::Range(1e-6, 1e6));
    asked->require_option(1);
    auto* device = job.add_option("--device", options->device,
                                  "Measure whole frames, simulated and drawn, on the GPU with this index in "
                                  "`devices`, instead of the engine on the CPU");
    job.add_option("--size", options->size, "Size WxH of these frames in pixels (default: 1920x1080)")
        ->needs(device);
    job.add_flag("--busy", options->busy,
                 "Answer even if times differ too much to be reliable, and add a note");
    job.add_option("--characters", options->characters,
                   "Number of characters with this hair that share the milliseconds")
        ->check(CLI::Range(1, 100'000));
    job.add_option("-o,--output", options->output, "Project to save with the settings found");
    job.add_option("--strands", options->strands,
                   "Number of strands to measure errors with, drawn from the groom")
        ->check(CLI::Range(1, 1'000'000));
    job.add_option("--repeat", options->repeats, "Timed runs of each candidate")->check(CLI::Range(1, 1000));
    addGroundTruthOptions(job, options->groundTruth);
    job.add_option("--seed", options->seed, "Random seed of the sample of strands");
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return budget(*options); });
    };
}

}  // namespace

Job budgetJob() {
    return {"budget", "Find the most accurate settings within a frame time",
            "hair.hairloom --ms 0.5 --motion nod --wind 3,0,1 -o fast.hairloom", declare};
}

}  // namespace hairloom::cli
