// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "cli/advice_report.h"
#include "cli/backend.h"
#include "cli/body_notes.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/jobs/simulate.h"
#include "cli/motions.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/record_comparison.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/documents/takes.h"
#include "core/editing/document.h"
#include "core/editing/take_shape.h"
#include "core/groom/file/project_file.h"
#include "core/groom/poses.h"
#include "core/live/drawn_depth.h"
#include "core/simulation/frame_record.h"
#include "core/simulation/morph_meter.h"
#include "core/simulation/rest_positions.h"
#include "core/simulation/sag.h"
#include "core/simulation/simulation.h"
#include "core/simulation/time_line_motion.h"

namespace hairloom::cli {
namespace {

SimulationOptions methodOf(const SimulateOptions& options) {
    SimulationOptions result;
    if (options.method == "projective") result.method = SimulationMethod::projective;
    if (options.method == "chain") result.method = SimulationMethod::chain;
    if (options.method == "lattice") result.method = SimulationMethod::lattice;
    if (options.method == "particles") result.method = SimulationMethod::particles;
    if (options.method == "hybrid") result.method = SimulationMethod::hybrid;
    return result;
}

/// NAME=AMOUNT. Keys of its amount, which come before it, go.
Status setPose(Groom& groom, const std::string& assignment) {
    const std::size_t equals = assignment.rfind('=');
    const std::string name = assignment.substr(0, equals);
    const std::string text = equals == std::string::npos ? "" : assignment.substr(equals + 1);
    const nlohmann::json value = nlohmann::json::parse(text, nullptr, false);
    const double amount = value.is_number() ? value.get<double>() : -1;
    if (!(amount >= 0 && amount <= 1))
        throw WrongUsage(fmt::format("--pose {}", assignment),
                         "expected NAME=AMOUNT with an amount of 0 to 1");
    const auto found = placeOfPose(groom, name);
    if (!found) return tl::unexpected(found.error());
    groom.poses[*found].amount = static_cast<float>(amount);
    if (groom.timeLine) {
        TimeLine line = *groom.timeLine;
        std::erase_if(line.settings,
                      [&](const SettingTrack& track) { return track.name == poseAttribute(name); });
        groom.timeLine = std::make_shared<const TimeLine>(std::move(line));
    }
    return {};
}

/// The settings of the groom with what the command line says instead.
Status overrideSettings(Groom& groom, const SimulateOptions& options) {
    const runtime::StrandModel own = groom.simulation.strandModel;
    const auto names = runtime::integratorNames();
    if (const auto chosen = std::ranges::find(names, options.integrator); chosen != names.end()) {
        groom.simulation.integrator = static_cast<runtime::Integrator>(chosen - names.begin());
        groom.simulation.strandModel = runtime::StrandModel::springs;  // rods have no other
    }
    if (options.model == "rods") groom.simulation.strandModel = runtime::StrandModel::rods;
    if (options.model == "springs") groom.simulation.strandModel = runtime::StrandModel::springs;
    if (groom.simulation.strandModel == runtime::StrandModel::springs && own == runtime::StrandModel::rods)
        groom.simulation.substeps = std::max(groom.simulation.substeps, runtime::kSpringSubsteps);
    groom.simulation.hairHair = groom.simulation.hairHair || options.hairHair;
    if (options.substeps > 0) groom.simulation.substeps = options.substeps;
    for (const std::string& pose : options.poses) {
        if (auto set = setPose(groom, pose); !set) return set;
    }
    return setWind(groom, options.wind);
}

Report effectsReport(const std::vector<EffectReport>& effects) {
    Report rows = Report::array();
    for (const EffectReport& effect : effects) {
        rows.push_back(Report{{"name", effect.name},
                              {"on", effect.on},
                              {"why", effect.why},
                              {"ms", effect.milliseconds ? Report(*effect.milliseconds) : Report()},
                              {"bytes", effect.bytes}});
    }
    return rows;
}

Report statsReport(const Groom& groom, const SimulationStats& stats) {
    Report report;
    report["strands"] = groom.strandCount();
    report["points"] = groom.pointCount();
    report["frames"] = stats.frames;
    report["ms_per_frame"] = stats.millisecondsPerFrame;
    report["ns_per_particle_substep"] = stats.nanosecondsPerParticleSubstep;
    report["max_stretch"] = finiteOrNull(stats.maxStretch);
    report["max_penetration_mm"] = finiteOrNull(stats.maxPenetrationMm);
    report["energy"] = finiteOrNull(stats.energy);
    report["nan_count"] = stats.nanCount;
    report["restored_strands"] = stats.restoredStrands;
    report["guarded_strands"] = stats.guardedStrands;
    report["resting_strands"] = stats.restingStrands;
    report["fastest_at_end_mm_s"] = finiteOrNull(stats.fastestMmPerSecond);
    report["state_hash"] = fmt::format("{:016x}", stats.stateHash);
    report["effects"] = effectsReport(stats.effects);
    return report;
}

/// Looks at how deep hair is in the head; none without a head that encloses anything.
std::optional<DrawnDepthMeter> depthMeter(const Groom& groom) {
    if (!groom.scalp) return std::nullopt;
    auto meter = DrawnDepthMeter::make(groom);
    if (meter) return std::move(*meter);
    log::warning("hair was not compared with the head: {}", meter.error().message());
    return std::nullopt;
}

void reportDepth(const std::optional<DrawnDepthMeter>& meter, Report& report) {
    for (const char* key : {"max_mesh_penetration_mm", "max_guide_penetration_mm", "authored_depth_mm",
                            "share_inside_mesh", "deepest_frame"})
        report[key] = {};
    if (!meter) return;
    const DrawnDepth depth = meter->result();
    report["max_mesh_penetration_mm"] = 1e3 * depth.deepest;
    report["max_guide_penetration_mm"] = 1e3 * depth.deepestGuide;
    report["authored_depth_mm"] = 1e3 * depth.authored;
    report["share_inside_mesh"] = depth.shareInside;
    if (depth.deepestFrame) report["deepest_frame"] = *depth.deepestFrame;
}

/// Null where no morph target moves a root.
Report morphReport(const MorphMeter::Found& found, const Groom& groom, std::vector<std::string>& notes) {
    constexpr float kTold = 0.0005f;  // metres
    if (found.farthest == 0) return {};
    if (groom.body && std::max(found.out, found.in) > kTold)
        notes.push_back(
            fmt::format("roots follow the skin that morph targets move, and the skin collider follows bones "
                        "alone. At roots, the skin gets {:.1f} mm out of the collider and {:.1f} mm into it",
                        1e3 * found.out, 1e3 * found.in));
    return {{"farthest_mm", 1e3 * found.farthest},
            {"out_mm", 1e3 * found.out},
            {"in_mm", 1e3 * found.in},
            {"collider", groom.body ? Report("bones") : Report()}};
}

Report sagReport(const Groom& groom, const Sag& sag) {
    constexpr double kHolds = 1;  // mm
    constexpr std::size_t kNamed = 20;
    const std::vector<SaggingStrand> sagging = strandsThatSag(groom, sag, kHolds);
    Report report{{"mean_mm", sag.meanMm},
                  {"max_mm", sag.maxMm},
                  {"residual", sag.residual},
                  {"strands_that_cannot", sagging.size()}};
    Report reasons = Report::array();
    for (std::size_t i = 0; i < std::min(sagging.size(), kNamed); ++i)
        reasons.push_back(
            Report{{"strand", sagging[i].strand}, {"mm", sagging[i].mm}, {"reason", sagging[i].reason}});
    report["reasons"] = std::move(reasons);
    return report;
}

/// Lets the authored shape hang, as it is and where it carries its weight.
Result<Report> sagOf(const Groom& groom, const SimulateOptions& options) {
    const auto before = measureSag(groom);
    if (!before) return tl::unexpected(before.error());
    const Groom held = holdingItsShape(groom);
    const auto after = measureSag(held);
    if (!after) return tl::unexpected(after.error());
    Report report;
    report["strands"] = groom.strandCount();
    report["points"] = groom.pointCount();
    report["sag_before"] = sagReport(groom, *before);
    report["sag"] = sagReport(held, *after);
    report["residual"] = after->residual;
    if (!options.output.empty()) {
        if (auto saved = saveProject(held, options.output); !saved) return tl::unexpected(saved.error());
        report["output"] = options.output;
    }
    return report;
}

/// What --engine says, and where it says nothing --backend.
Result<JobEngine> engineOf(const SimulateOptions& options, const Groom& groom) {
    if (options.engine.empty() && options.backend == "cpu")
        return JobEngine{{EngineKind::cpu, "the default"}, nullptr};
    if (options.engine == "auto" && options.method != "strands")
        return JobEngine{{EngineKind::cpu, "only the strand engine runs on a GPU"}, nullptr};
    std::optional<gpu::Backend> backend;
    if (options.backend != "cpu") backend = kGpuBackends.at(options.backend);
    return chooseJobEngine(options.engine.empty() ? "gpu" : options.engine, backend, options.device, groom);
}

/// The groom whose time line repeats, whatever it says itself.
void repeatTimeLine(Groom& groom) {
    if (!groom.timeLine || groom.timeLine->loop) return;
    TimeLine line = *groom.timeLine;
    line.loop = true;
    groom.timeLine = std::make_shared<const TimeLine>(std::move(line));
}

void checkLoopOptions(const SimulateOptions& options, std::uint64_t frames) {
    if (frames < 2 || options.loopBlend > frames)
        throw WrongUsage(fmt::format("--loop of {} frames with --loop-blend {}", frames, options.loopBlend),
                         "expected at least two frames, and no longer blend");
}

/// The frame as it is recorded and saved.
std::span<const Vec3f> shownFrame(std::optional<LoopCloser>& loop, const Simulation& simulation) {
    return loop ? loop->close(simulation.positions_ws()) : simulation.positions_ws();
}

}  // namespace

Report loopReport(const LoopReport& loop) {
    if (!loop.after.isClosed())
        log::warning("the loop is not closed: its end is {:.2f} mm and {:.0f} mm/s from its start",
                     loop.after.mm, loop.after.mmPerSecond);
    return Report{{"frames", loop.frames},
                  {"blend", loop.blend},
                  {"seam_mm", loop.after.mm},
                  {"seam_mm_s", loop.after.mmPerSecond},
                  {"seam_before_blend_mm", loop.before.mm},
                  {"seam_before_blend_mm_s", loop.before.mmPerSecond},
                  {"head_mm", loop.headMm},
                  {"blend_mm_s", loop.blendMmPerSecond},
                  {"closed", loop.after.isClosed()}};
}

Result<Groom> groomOfFrame(Groom groom, std::span<const Vec3f> positions_ws, const HeadPose& pose,
                           Report& report) {
    editing::Document document(std::move(groom));
    const std::vector<Vec3f> shape = restPositions(document.groom(), positions_ws, pose);
    auto command = editing::takeShape(document.model(), shape, true);
    if (!command) return tl::unexpected(command.error());
    document.perform(std::move(*command));
    Groom taken = std::move(document).takeGroom();
    const auto sag = measureSag(taken);
    if (!sag) return tl::unexpected(sag.error());
    report["sag"] = sagReport(taken, *sag);
    return taken;
}

Result<Report> simulate(const SimulateOptions& options) {
    checkMotion(options.motion);
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (auto status = overrideSettings(*groom, options); !status) return tl::unexpected(status.error());
    if (options.sag) return sagOf(*groom, options);
    const auto authoredLine = groom->timeLine;
    if (options.loop) repeatTimeLine(*groom);
    const auto motion = makeMotion(options.motion, options.character, *groom);
    if (!motion) return tl::unexpected(motion.error());
    const MotionSpan span =
        motionSpanOf(options.motion, *groom, options.framesPerSecond, options.frames, options.preRoll);
    const FramePace& pace = span.pace;
    const std::uint32_t steps = pace.steps();
    const float dt = pace.dt();
    std::optional<LoopCloser> loop;
    if (options.loop) {
        checkLoopOptions(options, span.frames);
        if (auto status = checkHeadRepeats(**motion, *groom, pace, span.frames); !status)
            return tl::unexpected(status.error());
        loop.emplace(groom->offsets.view(), span.frames, options.loopBlend, pace.framesPerSecond);
    }
    std::uint64_t repeated = 0;  // frames before the recorded ones, without the pre-roll
    const auto timeOf = [&](std::uint64_t frame, std::uint32_t step) {
        return pace.timeOf(static_cast<float>(repeated + frame) - static_cast<float>(options.handles), step);
    };
    const runtime::SimulationSettings authored = groom->simulation;
    KeyedSettings keyed(**motion, authored, timeOf(0, steps));
    groom->simulation = keyed.first();
    HeadPose pose = (*motion)->poseAt(timeOf(0, steps));
    SimulationOptions methodOptions = methodOf(options);
    const auto engine = engineOf(options, *groom);
    if (!engine) return tl::unexpected(engine.error());
    if (engine->gpu) methodOptions.backend = engine->gpu->engine();
    auto simulation = Simulation::make(*groom, pose, methodOptions);
    if (!simulation) return tl::unexpected(simulation.error());
    if (!options.style.empty()) {
        const auto style = openGroom(options.style);
        if (!style) return tl::unexpected(style.error());
        if (auto set = simulation->setStyle(style->positions()); !set)
            return tl::unexpected(inFile(set.error(), options.style));
    }
    const Report advice = adviceReport(*groom, dt);
    std::optional<FrameRecorder> recorder;
    if (!options.record.empty()) {
        std::string noted =
            takeNotes(options.motion, *groom, std::string(engineName(engine->choice.kind)), pace.preRoll);
        if (loop) noted = withLoop(noted, {0, span.frames, options.loopBlend});
        auto opened = FrameRecorder::open(options.record, *groom, pace.framesPerSecond, std::move(noted));
        if (!opened) return tl::unexpected(opened.error());
        recorder.emplace(std::move(*opened));
    }

    std::vector<std::string> notes =
        bodyNotes(*groom, pose,
                  options.method == "strands" || options.method == "particles" || options.method == "hybrid");
    if (methodOptions.method != SimulationMethod::strands && followsPoses(*groom))
        notes.push_back(fmt::format("the method '{}' follows no pose: use --method strands", options.method));
    std::optional<RecordComparison> comparison;
    if (!options.against.empty()) comparison.emplace(options.against);

    std::optional<DrawnDepthMeter> depth = depthMeter(*groom);
    MorphMeter morphs(*groom);
    const std::uint64_t frames = span.frames + 2 * options.handles;
    const std::uint64_t settling = loop ? options.loopRepeats * span.frames : 0;  // at most
    Progress progress("simulating", pace.preRoll + settling + frames);
    for (std::uint64_t frame = 1; frame <= pace.preRoll; ++frame) {
        for (std::uint32_t step = 1; step <= steps; ++step) simulation->step(dt, pose);
        if (const auto status = simulation->status(); !status) return tl::unexpected(status.error());
        progress.done(frame);
    }
    const auto stepFrame = [&](std::uint64_t frame) -> Status {
        for (std::uint32_t step = 1; step <= steps; ++step) {
            const float time = timeOf(frame, step);
            if (auto given = keyed.give(*simulation, time); !given) return given;
            HeadStep head = stepOf(**motion, pose, time - dt, time);
            simulation->step(dt, head);
            pose = std::move(head.end);
        }
        return simulation->status();
    };
    std::uint32_t repeats = 0;
    for (bool isSettled = false; loop && !isSettled && repeats < options.loopRepeats; ++repeats) {
        for (std::uint64_t frame = 1; frame <= span.frames; ++frame) {
            if (const auto stepped = stepFrame(frame); !stepped) return tl::unexpected(stepped.error());
            loop->lead(simulation->positions_ws());
            progress.done(pace.preRoll + repeated + frame);
        }
        repeated += span.frames;
        // The first repeat begins with hair at rest.
        const auto seam = loop->endRepeat();
        isSettled = seam && seam->isClosed();
    }
    std::vector<Vec3f> last;
    for (std::uint64_t frame = 1; frame <= frames; ++frame) {
        if (const auto stepped = stepFrame(frame); !stepped) return tl::unexpected(stepped.error());
        const std::span<const Vec3f> shown = shownFrame(loop, *simulation);
        if (depth) {
            // A tenth of a gigabyte for ten million points that nothing follows.
            const auto velocities_ws =
                groom->interpolation.followPerGuide > 0 ? simulation->velocities_ws() : std::vector<Vec3f>();
            depth->add(frame, shown, velocities_ws, inWorld(pose));
        }
        if (recorder) {
            if (auto added = recorder->add(shown, inWorld(pose)); !added)
                return tl::unexpected(added.error());
        }
        if (comparison) {
            if (auto compared = comparison->add(*groom, frame - 1, shown); !compared)
                return tl::unexpected(compared.error());
        }
        morphs.add(pose);
        if (frame == frames) last.assign(shown.begin(), shown.end());
        progress.done(pace.preRoll + settling + frame);
    }

    Report report = statsReport(*groom, simulation->stats());
    report["advice"] = advice;
    report["frames"] = span.frames;
    report["fps"] = pace.framesPerSecond;
    report["pre_roll"] = pace.preRoll;
    report["handles"] = options.handles;
    report["method"] = options.method;
    report["engine"] = engineName(engine->choice.kind);
    report["why"] = engine->choice.why;
    report["device"] = engine->gpu ? Report(engine->gpu->deviceName()) : Report();
    if (comparison) comparison->report(report);
    if (recorder) {
        if (auto finished = recorder->finish(); !finished) return tl::unexpected(finished.error());
        report["record"] = options.record;
    }
    reportDepth(depth, report);
    report["morph_targets"] = morphReport(morphs.found(), *groom, notes);
    if (loop) {
        report["loop"] = loopReport(loop->report());
        report["loop"]["repeats"] = repeats;
    }
    if (!options.output.empty()) {
        groom->simulation = authored;  // what is keyed is in the time line
        groom->timeLine = authoredLine;
        Result<Groom> kept = posedGroom(*groom, last, inWorld(pose));
        if (options.take) kept = groomOfFrame(*groom, last, pose, report);
        if (!kept) return tl::unexpected(kept.error());
        if (auto saved = saveProject(*kept, options.output); !saved) return tl::unexpected(saved.error());
        report["output"] = options.output;
        if (groom->body && !kept->body)
            notes.push_back(
                fmt::format("{}: has no skin collider, which is measured on the head at rest. Fit it to the "
                            "head as it stands there (colliders --fit field)",
                            options.output));
    }
    reportNotes(notes, report);
    return report;
}

std::vector<CLI::Option*> addSimulationOptions(CLI::App& job, SimulateOptions& options) {
    const std::vector<CLI::Option*> before = job.get_options();
    job.add_option("--frames", options.frames, "Frames to simulate (default: 60, or the time line's range)")
        ->check(CLI::Range(1, 1'000'000));
    job.add_option(
           "--pre-roll", options.preRoll,
           "Frames to simulate before these on the motion's first pose. They settle the hair, and are "
           "not recorded (default: 0, or the time line's)")
        ->check(CLI::Range(0, 100'000));
    job.add_option("--fps", options.framesPerSecond, "Frames per second (default: 60, or the time line's)")
        ->check(CLI::Range(1.0, 1000.0));
    job.add_option("--engine", options.engine,
                   "Device that simulates: the CPU, a GPU, or the one that was measured to be faster")
        ->check(CLI::IsMember({"auto", "cpu", "gpu"}));
    job.add_option("--backend", options.backend,
                   "Graphics API of the GPU. Without --engine, it selects the GPU")
        ->check(CLI::IsMember({"cpu", "vulkan", "d3d11"}));
    job.add_option("--device", options.device, "GPU to use, by its index in `devices`");
    job.add_option("--model", options.model, "Strand model, instead of the groom's own")
        ->check(CLI::IsMember({"rods", "springs"}));
    job.add_option("--integrator", options.integrator, "Integrator of springs. Uses springs")
        ->check(CLI::IsMember(runtime::integratorNames()));
    job.add_option(
           "--substeps", options.substeps,
           "Time steps per 1/60 s, instead of the groom's own. Springs on a groom of rods take at least 8")
        ->check(CLI::Range(1u, runtime::kMaxSubsteps));
    job.add_option("--wind", options.wind, "Wind velocity X,Y,Z in m/s, instead of the groom's own");
    job.add_option(
        "--motion", options.motion,
        "Head motion: none, spin, nod, clip:NAME, a keyframe file F.json, or timeline: the project's "
        "clips and keys of head, wind and settings");
    job.add_option("--character", options.character,
                   "File with skeleton and clips, if other than the scalp's file");
    job.add_option(
           "--method", options.method,
           "Simulation method: the strand engine, projective equations, chains of rigid segments, a "
           "lattice around the head, or the strand engine with hair as particles or on a flow grid in place "
           "of simulation.hairHair")
        ->check(CLI::IsMember({"strands", "projective", "chain", "lattice", "particles", "hybrid"}));
    job.add_flag("--hair-hair", options.hairHair,
                 "Turns on simulation.hairHair, hair-hair collision of rods and projective equations");
    job.add_option("--pose", options.poses,
                   "How far hair follows a pose of the groom, as NAME=AMOUNT of 0 to 1, instead of the "
                   "groom's own. Of the strand engine on the CPU")
        ->delimiter(',');
    job.add_option(
        "--style", options.style,
        "Groom of the same strands, whose shape they turn to from the first frame on. Of projective "
        "equations");
    job.add_option("--loop-blend", options.loopBlend,
                   "Frames at the end of a loop that are blended into those before its first one. 0 blends "
                   "nothing")
        ->check(CLI::Range(0, 10'000));
    job.add_option("--loop-repeats", options.loopRepeats,
                   "Repeats that settle a loop at most, before the one that is kept")
        ->check(CLI::Range(1, 1000));
    std::vector<CLI::Option*> added = job.get_options();
    added.erase(added.begin(), added.begin() + static_cast<std::ptrdiff_t>(before.size()));
    return added;
}

namespace {

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<SimulateOptions>();
    job.add_option("groom", options->input, "Project or hair file")->required();
    addSimulationOptions(job, *options);
    auto* loop = job.add_flag("--loop", options->loop,
                              "Simulate repeats of --frames until hair ends each as the last one, then one "
                              "more that closes: its last frame leads to its first");
    for (const char* of : {"--loop-blend", "--loop-repeats"}) job.get_option(of)->needs(loop);
    auto* sag =
        job.add_flag("--sag", options->sag,
                     "Let the authored shape hang under gravity and contact for two seconds. Reports how far "
                     "each strand sags, as it is and as rods that carry their weight. -o saves the latter");
    auto* record = job.add_option("--record", options->record,
                                  "File for all frames, or a take where it ends in .hltake");
    auto* handles =
        job.add_option("--handles", options->handles,
                       "Number of frames to simulate and record before and behind --frames as well. "
                       "Frame 0 of the motion keeps its time: keys before it and the end of clips "
                       "move the first handles")
            ->check(CLI::Range(0, 1000))
            ->needs(record)
            ->excludes(loop);
    job.add_option("--against", options->against,
                   "Record of the same groom and frames, to measure the distance from");
    auto* output = job.add_option("-o,--output", options->output, "Project to write, with the last frame")
                       ->excludes(handles);
    job.add_flag("--take", options->take,
                 "Makes the last frame the authored shape that -o writes, on the head at rest, as rods that "
                 "carry their weight. The operators stay, with a sculpt on top")
        ->needs(output);
    // It has two seconds, the head at rest and a solver of its own.
    for (const char* other :
         {"--frames", "--pre-roll", "--handles", "--fps", "--engine", "--backend", "--device", "--motion",
          "--character", "--method", "--hair-hair", "--style", "--record", "--against", "--take", "--loop"})
        sag->excludes(other);
    return [options](const std::string&) {
        return withOutputs(
            {{options->output, content::kProject}, {options->record, recordKind(options->record)}},
            [&] { return simulate(*options); });
    };
}

}  // namespace

Job simulateJob() {
    return {"simulate", "Run the simulation and report how it went",
            "hair.hairloom --frames 120 --wind 3,0,1 --motion nod --record hair.frames", declare};
}

}  // namespace hairloom::cli
