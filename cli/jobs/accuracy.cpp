// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "cli/accuracy_jobs.h"
#include "cli/backend.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/motions.h"
#include "cli/outputs.h"
#include "cli/picture_accuracy.h"
#include "cli/progress.h"
#include "core/accuracy/compare_reports.h"
#include "core/accuracy/peers.h"
#include "core/accuracy/work_precision_report.h"
#include "core/base/file.h"
#include "core/live/groom_scene.h"
#include "core/live/view_file.h"

namespace hairloom::cli {
namespace {

struct AccuracyOptions {
    MotionOptions motion;
    std::string output;
    std::uint32_t strands = 200;
    std::uint32_t repeats = 5;
    std::uint64_t seed = 1;
    GroundTruthOptions groundTruth;
    std::vector<std::string> integrators, substeps, iterations, points, threadCounts;
    std::vector<std::string> vary;  ///< FIELD=V1,V2,…
    std::string view;               ///< view file; empty for none
    std::string peers;              ///< CSV of ./dev peers; empty for the recorded one
    PictureAccuracyOptions picture;
    std::vector<std::string> compared;  ///< two folders of earlier reports, or none
};

constexpr std::uint64_t kMaxPeerBytes = std::uint64_t{1} << 20u;

/// The groom's own number of points, and a half and a quarter of it.
std::vector<std::string> pointsToTry(const Groom& groom) {
    const std::uint32_t own = maxPoints(groom);
    std::vector<std::string> counts;
    for (const std::uint32_t part : {4u, 2u, 1u}) {
        constexpr std::uint32_t kFewest = 4;
        counts.push_back(fmt::format("{}", std::max(own / part, std::min(own, kFewest))));
    }
    return counts;
}

/// "FIELD=V1,V2" as an axis.
GridAxis parseVariation(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        throw WrongUsage(fmt::format("--vary is '{}'", text), "expected FIELD=VALUE,VALUE,…");
    }
    std::vector<std::string> values;
    for (std::size_t at = equals; at != std::string::npos;) {
        const std::size_t next = text.find(',', at + 1);
        values.push_back(text.substr(at + 1, next == std::string::npos ? next : next - at - 1));
        at = next;
    }
    return orWrongUsage(parseAxis(text.substr(0, equals), values));
}

std::vector<GridAxis> axesOf(const AccuracyOptions& options, const Groom& groom) {
    const bool springs = groom.simulation.strandModel == runtime::StrandModel::springs;
    const std::string own = nameOf(groom.simulation.integrator);
    const auto orElse = [](const std::vector<std::string>& given, const std::vector<std::string>& otherwise) {
        return given.empty() ? otherwise : given;
    };
    std::vector<std::pair<std::string_view, std::vector<std::string>>> wanted;
    if (springs) wanted.emplace_back("integrator", orElse(options.integrators, {own}));
    wanted.emplace_back("substeps", orElse(options.substeps, {"1", "2", "4", "8", "16", "32"}));
    if (springs) wanted.emplace_back("lengthIterations", orElse(options.iterations, {"1", "2"}));
    wanted.emplace_back(kPointsAxis, orElse(options.points, pointsToTry(groom)));
    if (!options.threadCounts.empty()) wanted.emplace_back(kThreadsAxis, options.threadCounts);
    std::vector<GridAxis> axes;
    for (const auto& [field, values] : wanted) axes.push_back(orWrongUsage(parseAxis(field, values)));
    for (const std::string& variation : options.vary) axes.push_back(parseVariation(variation));
    return axes;
}

Report settingReport(const WorkPrecision& result, const WorkPrecisionRun& run) {
    Report setting = Report::object();
    for (std::size_t a = 0; a < run.values.size(); ++a) {
        const GridAxis& axis = result.options.axes[a];
        const double value = run.values[a];
        if (isEnumeration(axis.field)) {
            setting[axis.field] = axisValueText(axis, value);
        } else if (value == std::floor(value)) {
            setting[axis.field] = std::llround(value);
        } else {
            setting[axis.field] = value;
        }
    }
    return setting;
}

/// Of the view, in the middle of the hair, seen side-on; nothing without a view. Errors: a view that cannot
/// be read, or says no camera or size.
Result<std::optional<double>> pixelsPerMm(const std::string& file, const Groom& groom) {
    if (file.empty()) return std::nullopt;
    const auto view = readViewFile(file);
    if (!view) return tl::unexpected(view.error());
    if (!view->camera || !view->size || view->size->second == 0)
        return failIn(file, {}, "the view has no camera or no size",
                      "expected both, to measure errors in pixels");
    const float metres = render::metresPerPixel(*view->camera, groom.bounds().center(),
                                                static_cast<float>(view->size->second));
    return 1e-3 / static_cast<double>(metres);
}

Report rowOf(const WorkPrecision& result, const WorkPrecisionRun& run, std::optional<double> pixelsPerMm) {
    Report row{{"setting", settingReport(result, run)}};
    if (run.diverged) return row;
    row["ms"] = run.milliseconds.median;
    row["error_mm"] = run.error.rmsMm;
    row["error_mm_max"] = run.error.maxMm;
    if (pixelsPerMm) row["error_px"] = run.error.rmsMm * *pixelsPerMm;
    row["drop_mm"] = finiteOrNull(run.other.dropMm);
    row["after_shake_mm"] = finiteOrNull(run.other.returnMm);
    row["head_depth_mm"] = run.other.headDepthMm;
    row["sphere_depth_mm"] = run.other.sphereDepthMm;
    row["rest_speed_mm_s"] = finiteOrNull(1e3 * run.other.restSpeed);
    if (run.parts) {
        row["step_error_mm"] = run.parts->step.rmsMm;
        row["points_error_mm"] = run.parts->points.rmsMm;
        row["model_error_mm"] = run.parts->model.rmsMm;
    }
    return row;
}

/// The fastest first.
Report frontReport(const WorkPrecision& result, std::optional<double> pixelsPerMm) {
    std::vector<const WorkPrecisionRun*> front;
    for (const WorkPrecisionRun& run : result.runs) {
        if (run.onFront) front.push_back(&run);
    }
    std::ranges::sort(front, {}, [](const WorkPrecisionRun* run) { return run->milliseconds.median; });
    Report rows = Report::array();
    for (const WorkPrecisionRun* run : front) {
        rows.push_back(rowOf(result, *run, pixelsPerMm));
    }
    return rows;
}

Result<std::vector<PeerRun>> peersOf(const AccuracyOptions& options) {
    if (options.peers.empty()) return recordedPeers();
    const auto text = readTextFile(options.peers, kMaxPeerBytes);
    if (!text) return tl::unexpected(text.error());
    return parsePeers(*text, options.peers);
}

Report peersReport(const std::vector<PeerRun>& peers) {
    Report rows = Report::array();
    for (const PeerRun& run : peers)
        rows.push_back(Report{{"name", run.name},
                              {"version", run.version},
                              {"setting", run.setting},
                              {"strands", run.strands},
                              {"ms", finiteOrNull(run.milliseconds)},
                              {"ms_lowest", finiteOrNull(run.lowestMs)},
                              {"ms_highest", finiteOrNull(run.highestMs)},
                              {"error_mm", finiteOrNull(run.errorMm)},
                              {"error_mm_max", finiteOrNull(run.errorMaxMm)},
                              {"stretch_percent", finiteOrNull(run.stretchPercent)},
                              {"stretch_percent_max", finiteOrNull(run.stretchMaxPercent)},
                              {"cantilever_mm", finiteOrNull(run.cantileverMm)},
                              {"reference", run.reference},
                              {"reference_uncertainty_mm", finiteOrNull(run.referenceUncertaintyMm)},
                              {"machine", run.machine},
                              {"load", finiteOrNull(run.load)},
                              {"date", run.date}});
    return rows;
}

Result<Report> accuracy(const AccuracyOptions& options, const std::string& commandLine) {
    const auto peers = peersOf(options);
    if (!peers) return tl::unexpected(peers.error());
    auto scene = openMovingGroom(options.motion);
    if (!scene) return tl::unexpected(scene.error());
    // Rods have neither integrators nor corrections of length.
    if (!options.integrators.empty() || !options.iterations.empty())
        scene->groom.simulation.strandModel = runtime::StrandModel::springs;
    const auto scale = pixelsPerMm(options.view, scene->groom);
    if (!scale) return tl::unexpected(scale.error());
    WorkPrecisionOptions measuring;
    measuring.axes = axesOf(options, scene->groom);
    measuring.time.frames = options.motion.frames;
    measuring.time.framesPerSecond = options.motion.framesPerSecond;
    measuring.strands = options.strands;
    measuring.repeats = options.repeats;
    measuring.seed = options.seed;
    const auto engine = findAxis(measuring.axes, kEngineAxis);
    std::unique_ptr<GpuBackend> gpu;
    if (engine &&
        std::ranges::find(measuring.axes[*engine].values, 1.0) != measuring.axes[*engine].values.end()) {
        auto made = GpuBackend::make(std::nullopt, options.picture.device);
        if (!made) return tl::unexpected(made.error());
        gpu = std::move(*made);
        measuring.gpuEngine = gpu->engine();
    }
    std::optional<Progress> progress;
    measuring.progress = [&](std::size_t done, std::size_t total) {
        if (!progress) progress.emplace("measuring", total);
        progress->done(done);
    };
    const auto result =
        measureWorkPrecision(scene->groom, *scene->motion, measuring, *makeGroundTruth(options.groundTruth));
    progress.reset();
    if (!result) return tl::unexpected(result.error());
    const auto files = writeWorkPrecision(
        *result, {options.motion.input, options.motion.motion, commandLine, *peers}, options.output);
    if (!files) return tl::unexpected(files.error());

    Report report;
    report["device"] = gpu ? Report(gpu->deviceName()) : Report();
    report["strands"] = result->strands;
    report["strands_compared"] = result->strandsCompared;
    report["frames"] = measuring.time.frames;
    report["runs"] = result->runs.size();
    report["diverged"] = std::ranges::count_if(result->runs, &WorkPrecisionRun::diverged);
    report["truth"] = result->groundTruthName;
    report["truth_detail"] = result->groundTruthDetail;
    report["truth_uncertainty_mm"] = result->groundTruthUncertaintyMm;
    report["front"] = frontReport(*result, *scale);
    report["rows"] = Report::array();
    for (const WorkPrecisionRun& run : result->runs) {
        report["rows"].push_back(rowOf(*result, run, *scale));
        report["rows"].back()["diverged"] = run.diverged;
        report["rows"].back()["trembles"] = run.trembling > 0;
    }
    report["peers"] = peersReport(*peers);
    report["peers_scene"] = peerScene();
    report["notes"] = result->notes;
    report["output"] = options.output;
    report["files"] = *files;
    return report;
}

Report rowOf(const ComparedRun& run) {
    Report row{{"setting", run.setting}, {"slower", run.slower}, {"less_exact", run.lessExact}};
    if (!run.divergedBefore) row["before"] = Report{{"ms", run.msBefore}, {"error_mm", run.errorBefore}};
    if (!run.divergedAfter) row["after"] = Report{{"ms", run.msAfter}, {"error_mm", run.errorAfter}};
    return row;
}

Result<Report> compareFolders(const std::vector<std::string>& folders) {
    std::vector<std::string> tables;
    for (const std::string& folder : folders) {
        auto table = readTextFile(std::filesystem::path(folder) / "data.csv");
        if (!table) return tl::unexpected(table.error());
        tables.push_back(std::move(*table));
    }
    const auto result = compareReports(tables[0], tables[1]);
    if (!result) return tl::unexpected(inFile(result.error(), folders[0] + ", " + folders[1]));
    Report report{
        {"compared", result->runs.size()}, {"regressions", Report::array()}, {"rows", Report::array()}};
    for (const ComparedRun& run : result->runs) {
        report["rows"].push_back(rowOf(run));
        if (run.slower || run.lessExact) report["regressions"].push_back(rowOf(run));
    }
    report["missing"] = result->missing;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<AccuracyOptions>();
    addMotionOptions(job, options->motion);
    job.add_option("-o,--output", options->output, "Folder for report.html, data.csv and the plots")
        ->required();
    job.add_option(
           "--strands", options->strands,
           "Number of strands to run, drawn at random from the groom. All of them run where guides vary")
        ->check(CLI::Range(1, 1'000'000));
    const auto list = [&](const char* name, std::vector<std::string>& values, const char* does) {
        job.add_option(name, values, does)->delimiter(',');
    };
    list("--integrators", options->integrators,
         "Integrators of springs to measure instead of the groom's own. Uses springs");
    list("--substeps", options->substeps, "Steps per 1/60 s to measure");
    list("--iterations", options->iterations,
         "Length iterations per substep of springs to measure. Uses springs");
    list("--points", options->points,
         "Points per strand to measure, instead of the groom's own, a half and a quarter");
    list("--thread-counts", options->threadCounts, "Thread counts to measure instead of --threads");
    job.add_option("--vary", options->vary,
                   "Another setting to measure as FIELD=VALUE,VALUE,… You can repeat this option. FIELD is a "
                   "simulation setting, engine (cpu,gpu), headSeen (ends,quarters: poses of the head within "
                   "a frame), hairVolume (0,1: hair-hair collision between frames), spheres (first N "
                   "spheres), guides (N simulated strands; the others follow) or hairsPerGuide (time only)");
    job.add_option("--view", options->view,
                   "View file (docs/cli.md) with a camera and a size. Adds errors in pixels of this view")
        ->type_name("FILE");
    job.add_option("--peers", options->peers,
                   "CSV of other simulators that ./dev peers measured on your machine, for the table beside "
                   "the front "
                   "in the report (default: the measurement that came with this version)")
        ->type_name("FILE");
    job.add_option("--repeat", options->repeats, "Timed runs of each setting")->check(CLI::Range(1, 1000));
    addGroundTruthOptions(job, options->groundTruth);
    job.add_option("--seed", options->seed, "Random seed of the sample of strands");
    addPictureAccuracyOptions(job, options->picture);
    auto* compare = job.add_option("--compare", options->compared,
                                   "Compares two report folders instead of measuring, and lists settings "
                                   "that are slower or less accurate in the second")
                        ->expected(2);
    for (const char* name : {"groom", "--output"}) job.get_option(name)->required(false);
    job.final_callback([&job, compare] {
        for (const char* name : {"groom", "--output"}) {
            if (compare->count() == 0 && job.get_option(name)->count() == 0) throw CLI::RequiredError(name);
        }
    });
    return [options](const std::string& commandLine) {
        if (!options->compared.empty()) return compareFolders(options->compared);
        return withOutputFolder(
            options->output,
            options->picture.wanted ? std::vector<std::string>{"report.html", "picture.csv", "picture.svg"}
                                    : std::vector<std::string>{"report.html", "data.csv"},
            [&] {
                return options->picture.wanted
                           ? pictureAccuracy(options->picture, options->motion.input, options->view,
                                             options->repeats, options->output, commandLine)
                           : accuracy(*options, commandLine);
            });
    };
}

}  // namespace

Job accuracyJob() {
    return {"accuracy", "Measure time and error for a grid of settings",
            "hair.hairloom -o accuracy --motion nod --wind 3,0,1 --substeps 1,2,4,8,16", declare};
}

}  // namespace hairloom::cli
