// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <system_error>
#include <tuple>

#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/jobs/simulate.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/base/write_rules.h"
#include "core/documents/motions.h"
#include "core/documents/take_edit.h"
#include "core/documents/take_export.h"
#include "core/documents/takes.h"
#include "core/groom/file/project_file.h"
#include "core/live/film.h"
#include "core/simulation/frame_record.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWebpFormat = "webp";
constexpr const char* kMp4Format = "mp4";

bool isFilmFormat(const std::string& format) {
    return format == kWebpFormat || format == kMp4Format;
}

struct TakesOptions {
    SimulateOptions simulation;  ///< with the groom
    std::string record;          ///< names of takes, also below
    std::string exported;
    std::string removed;
    std::vector<std::string> renamed;
    std::vector<std::string> compared;
    std::string closed;
    std::string resimulated;
    std::string shaped;
    std::string to;                   ///< name of the take that the first two make
    std::optional<std::uint64_t> at;  ///< frame of the latter two
    std::string format;
    std::vector<std::uint64_t> range;  ///< first and last frame to export or to close; empty: all
    bool loops = false;
    std::string what = "guides";
    std::string size = "640x640";
    std::string camera = "three-quarter";
    std::string output;
};

Report rowOfTake(const Take& take, const Groom& groom) {
    const TakeInfo& info = take.info;
    const std::string motion = motionOfNotes(info.notes);
    const double points = static_cast<double>(info.points) * static_cast<double>(info.frames);
    Report row{{"name", take.name},
               {"frames", info.frames},
               {"fps", info.framesPerSecond},
               {"bytes", info.bytes},
               {"bytes_per_point_and_frame",
                points > 0 ? Report(static_cast<double>(info.bytes) / points) : Report()},
               {"max_error_mm", 1e3 * static_cast<double>(info.largestError)},
               {"motion", motion.empty() ? Report() : Report(motion)},
               {"loops", loopOfNotes(info.notes).has_value()},
               {"finished", info.isFinished},
               {"groom_changed", info.shapeHash != takeShapeHash(groom)},
               {"file", take.file.string()}};
    if (!take.problem.empty()) row["problem"] = take.problem;
    return row;
}

void warnOfChange(const Take& take, const Groom& groom) {
    if (take.problem.empty() && take.info.shapeHash != takeShapeHash(groom))
        log::warning("take '{}' was recorded before the groom or its head changed shape", take.name);
}

Report rowsOf(const Takes& found, const Groom& groom) {
    for (const std::string& name : found.recovered)
        log::warning("take '{}' was recovered: its recording was ended before it was done", name);
    Report rows = Report::array();
    for (const Take& take : found.takes) {
        if (!take.problem.empty()) log::warning("{}", take.problem);
        warnOfChange(take, groom);
        rows.push_back(rowOfTake(take, groom));
    }
    return rows;
}

Result<Report> listTakes(const TakesOptions& options) {
    const auto groom = openGroom(options.simulation.input);
    if (!groom) return tl::unexpected(groom.error());
    const Takes found = findTakes(options.simulation.input);
    return Report{{"folder", takesFolder(options.simulation.input).string()},
                  {"takes", rowsOf(found, *groom)},
                  {"recovered", found.recovered}};
}

/// A take that is there, and a warning where it is of another shape.
Result<fs::path> takeFor(const TakesOptions& options, const std::string& name, const Groom& groom) {
    auto path = existingTake(options.simulation.input, name);
    if (!path) return path;
    const auto reader = TakeReader::open(*path);
    if (!reader) return tl::unexpected(reader.error());
    warnOfChange({name, *path, reader->info(), {}}, groom);
    return path;
}

// --- Recording ---

/// Runs what writes a take of that name, and adds the take's row to its report.
Result<Report> withNewTake(const TakesOptions& options, const std::string& name,
                           const std::function<Result<Report>(const fs::path&)>& write) {
    const auto path = takePath(options.simulation.input, name);
    if (!path) throw WrongUsage(path.error());
    std::error_code code;
    if (!fs::is_regular_file(options.simulation.input, code))
        return failIn(options.simulation.input, {}, "is not a file", "expected a project or hair file");
    findTakes(options.simulation.input);  // what was cut off gets its name before another takes it
    if (fs::exists(*path, code) && !writeRules().force)
        return failIn(path->string(), {}, fmt::format("there is a take '{}' already", name),
                      "expected another name, or --force");
    const fs::path folder = takesFolder(options.simulation.input);
    fs::create_directory(folder, code);
    if (code)
        return failIn(folder.string(), {}, "the folder cannot be made: " + code.message(),
                      "expected a folder that can be written");
    auto report = withOutputs({{path->string(), content::kTake}}, [&] { return write(*path); });
    if (!report) {
        fs::remove(folder, code);  // where nothing is in it
        return report;
    }
    const auto groom = openGroom(options.simulation.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto reader = TakeReader::open(*path);
    if (!reader) return tl::unexpected(reader.error());
    (*report)["takes"] = Report::array({rowOfTake({name, *path, reader->info(), {}}, *groom)});
    return report;
}

Result<Report> recordTake(TakesOptions& options) {
    options.simulation.loop = options.loops;
    return withNewTake(options, options.record, [&](const fs::path& path) {
        options.simulation.record = path.string();
        return simulate(options.simulation);
    });
}

// --- Takes of takes ---

/// The frames that are asked for. Throws WrongUsage where the take has no such.
std::pair<std::uint64_t, std::uint64_t> rangeOf(const TakesOptions& options, const TakeInfo& info) {
    if (info.frames == 0) throw WrongUsage("the take has no frames", "expected one with frames");
    if (options.range.empty()) return {0, info.frames - 1};
    if (options.range.size() != 2 || options.range[1] < options.range[0])
        throw WrongUsage("--range runs backwards or is not two numbers", "FIRST,LAST");
    if (options.range[1] >= info.frames)
        throw WrongUsage(fmt::format("--range ends at frame {}", options.range[1]),
                         fmt::format("the take has {} frames, counted from 0", info.frames));
    return {options.range[0], options.range[1]};
}

struct OpenedTake {
    Groom groom;
    fs::path path;
    TakeReader reader;
};
Result<OpenedTake> openTake(const TakesOptions& options, const std::string& name) {
    auto groom = openGroom(options.simulation.input);
    if (!groom) return tl::unexpected(groom.error());
    auto path = existingTake(options.simulation.input, name);
    if (!path) return tl::unexpected(path.error());
    auto reader = TakeReader::open(*path);
    if (!reader) return tl::unexpected(reader.error());
    warnOfChange({name, *path, reader->info(), {}}, *groom);
    if (auto status = reader->use(*groom); !status) return tl::unexpected(status.error());
    return OpenedTake{std::move(*groom), std::move(*path), std::move(*reader)};
}

WorkWatch watchOf(Progress& progress) {
    WorkWatch watch;
    watch.progress = [&progress](double share) { progress.done(static_cast<std::size_t>(100 * share)); };
    return watch;
}

Result<Report> closeTake(const TakesOptions& options) {
    auto take = openTake(options, options.closed);
    if (!take) return tl::unexpected(take.error());
    const std::uint64_t blend = options.simulation.loopBlend;
    LoopToMake wanted{0, 0, blend, {}};
    if (options.range.empty()) {
        const auto repeat = lastRepeat(take->reader.info(), take->groom, blend);
        if (!repeat) return tl::unexpected(repeat.error());
        std::tie(wanted.first, wanted.last) = *repeat;
    } else {
        std::tie(wanted.first, wanted.last) = rangeOf(options, take->reader.info());
    }
    return withNewTake(options, options.to, [&](const fs::path& path) -> Result<Report> {
        Progress progress("closing", 100);
        wanted.watch = watchOf(progress);
        const auto made = makeLoop(take->reader, take->groom, wanted, path);
        if (!made) return tl::unexpected(made.error());
        Report report{{"loop", loopReport(*made)}};
        report["loop"]["first"] = wanted.first;
        report["loop"]["last"] = wanted.last;
        return report;
    });
}

Result<Report> resimulateTake(const TakesOptions& options) {
    auto take = openTake(options, options.resimulated);
    if (!take) return tl::unexpected(take.error());
    const std::string name = motionOfNotes(take->reader.info().notes);
    const auto motion = makeMotion(name.empty() ? "none" : name, options.simulation.character, take->groom);
    if (!motion) return tl::unexpected(motion.error());
    return withNewTake(options, options.to, [&](const fs::path& path) -> Result<Report> {
        Progress progress("simulating", 100);
        const TakeToResume wanted{*options.at, options.simulation.frames.value_or(0), watchOf(progress)};
        const auto made = resumeTake(take->reader, take->groom, **motion, name, wanted, path);
        if (!made) return tl::unexpected(made.error());
        return Report{{"kept", made->kept}, {"simulated", made->simulated}, {"head_mm", made->headMm}};
    });
}

Result<Report> shapeOfTake(const TakesOptions& options) {
    auto take = openTake(options, options.shaped);
    if (!take) return tl::unexpected(take.error());
    const auto frame = take->reader.frame(*options.at);
    if (!frame) return tl::unexpected(frame.error());
    Report report{{"frame", *options.at}};
    const auto groom = groomOfFrame(take->groom, frame->positions_ws, frame->pose, report);
    if (!groom) return tl::unexpected(groom.error());
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    report["output"] = options.output;
    return report;
}

// --- Export ---

Result<Report> exportFrames(TakeReader& reader, const Groom& groom,
                            std::pair<std::uint64_t, std::uint64_t> range, const TakesOptions& options) {
    Progress progress("exporting", 100);
    TakeToExport wanted{options.exported, options.format, range.first, range.second, options.loops, {}};
    wanted.hair = options.what == "all"     ? ExportedHair::all
                  : options.what == "hairs" ? ExportedHair::hairs
                                            : ExportedHair::guides;
    wanted.watch = watchOf(progress);
    // All of a take that repeats is a clip that does.
    if (options.format == "runtime" && range.second - range.first + 1 == reader.info().frames)
        wanted.loops = wanted.loops || loopOfNotes(reader.info().notes).has_value();
    const auto written = exportTake(reader, groom, wanted, options.output);
    if (!written) return tl::unexpected(written.error());
    if (options.format == kRecordFormat)
        return Report{{"frames", written->frames}, {"output", options.output}};
    tellFindings(written->findings);
    Report report = toJson(*written);
    report["frames"] = range.second - range.first + 1;
    return report;
}

Result<Report> exportFilm(const TakeInfo& info, std::pair<std::uint64_t, std::uint64_t> range,
                          const fs::path& take, const TakesOptions& options) {
    // Images of WebP are held, and 30 a second are what browsers show of it. A video has all frames.
    const bool isVideo = options.format == kMp4Format;
    if (AnimationFile::kindOf(options.output) !=
        (isVideo ? AnimationFile::Kind::Mp4 : AnimationFile::Kind::Webp))
        throw WrongUsage(fmt::format("--format {} with a name of another kind", options.format),
                         fmt::format("expected -o F.{}", options.format));
    const double kMostRate = isVideo ? 240 : 30;
    const auto rate = static_cast<double>(info.framesPerSecond);
    const auto step = static_cast<std::uint64_t>(std::max(1.0, std::round(rate / kMostRate)));
    RenderJobOptions film;
    film.input = options.simulation.input;
    film.record = take.string();
    film.frames = {range.first, range.second, step};
    film.size = options.size;
    film.camera = options.camera;
    film.animation = options.output;
    film.framesPerSecond = rate / static_cast<double>(step);
    constexpr double kMost = 2e9;
    const auto how = pictureOptions(film, {});
    const auto shots = shotsOf(film);
    if (!how) return tl::unexpected(how.error());
    if (!shots) return tl::unexpected(shots.error());
    const double bytes = 4.0 * how->width * how->height * static_cast<double>(shots->size());
    if (!isVideo && bytes > kMost)
        return fail(
            fmt::format("{} images of {} take {:.1f} GB of memory", shots->size(), options.size, bytes / 1e9),
            fmt::format("expected at most {:.0f} GB: --format mp4, a smaller --size or --range",
                        kMost / 1e9));
    auto report = renderToFile(film);
    if (report) (*report)["output"] = options.output;
    if (report) (*report)["fps"] = *film.framesPerSecond;
    return report;
}

Result<Report> exportNamed(const TakesOptions& options) {
    if (options.loops && options.format != "runtime")
        throw WrongUsage("--loop with --format " + options.format, "expected it with --format runtime");
    if (options.what != "guides" && !canExportHairs(options.format))
        throw WrongUsage(fmt::format("--what {} with --format {}", options.what, options.format),
                         "expected it with a format of export with animation, as abc");
    auto take = openTake(options, options.exported);
    if (!take) return tl::unexpected(take.error());
    const auto range = rangeOf(options, take->reader.info());
    if (!isFilmFormat(options.format)) return exportFrames(take->reader, take->groom, range, options);
    return exportFilm(take->reader.info(), range, take->path, options);
}

std::string_view kindOfExport(const std::string& format) {
    if (format == kRecordFormat) return content::kFrames;
    if (format == kMp4Format) return content::kMp4;
    if (format == kWebpFormat) return {};
    return contentKindOfSuffix(strandWriter(format, hairWriters()).suffix());
}

std::vector<std::string> takeFormats() {
    std::vector<std::string> names = takeExportFormats();
    names.insert(names.end(), {kWebpFormat, kMp4Format});
    return names;
}

// --- The rest ---

Result<Report> distanceOfTakes(const TakesOptions& options) {
    if (options.compared.size() != 2)
        throw WrongUsage("--compare is not the names of two takes", "expected --compare A B");
    const auto groom = openGroom(options.simulation.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto a = takeFor(options, options.compared[0], *groom);
    if (!a) return tl::unexpected(a.error());
    const auto b = takeFor(options, options.compared[1], *groom);
    if (!b) return tl::unexpected(b.error());
    const auto difference = compareTakes(*a, *b, *groom, [](std::uint64_t) {});
    if (!difference) return tl::unexpected(difference.error());
    Report rows = Report::array();
    for (const TakeDifference::Frame& frame : difference->frames)
        rows.push_back(Report{{"frame", frame.number}, {"rms_mm", frame.rmsMm}, {"max_mm", frame.largestMm}});
    Report report{{"takes", options.compared},
                  {"frames", difference->frames.size()},
                  {"rms_mm", difference->rmsMm},
                  {"max_mm", difference->largestMm},
                  {"worst_frame", difference->worstFrame}};
    if (isReportJson()) report["by_frame"] = std::move(rows);
    return report;
}

/// Options that CLI11 cannot tie to one of several others.
void checkTogether(const TakesOptions& options, const CLI::App& job) {
    const auto given = [&](const char* name) { return job.count(name) > 0; };
    const auto needs = [&](const char* name, const std::string& ways, bool has) {
        if (given(name) && !has) throw WrongUsage(fmt::format("{} without {}", name, ways), "expected both");
    };
    const bool makes = given("--close") || given("--resimulate");
    needs("--to", "--close or --resimulate", makes);
    needs("--at", "--resimulate or --shape", given("--resimulate") || given("--shape"));
    needs("--frames", "--record or --resimulate", given("--record") || given("--resimulate"));
    needs("--range", "--export or --close", given("--export") || given("--close"));
    needs("--character", "--record or --resimulate", given("--record") || given("--resimulate"));
    needs("--loop", "--record or --export", given("--record") || given("--export"));
    needs("--loop-repeats", "--loop", options.loops && given("--record"));
    needs("--loop-blend", "--loop or --close", (options.loops && given("--record")) || given("--close"));
    needs("--output", "--export or --shape", given("--export") || given("--shape"));
    if (makes && !given("--to")) throw WrongUsage("--to is missing", "the name of the take to make");
    if (given("--resimulate") && !given("--at")) throw WrongUsage("--at is missing", "a frame of the take");
    if (given("--shape") && (!given("--at") || !given("--output")))
        throw WrongUsage("--shape needs --at and -o", "--shape NAME --at FRAME -o G2.hairloom");
}

Result<Report> runTakes(TakesOptions& options) {
    if (!options.record.empty()) return recordTake(options);
    if (!options.closed.empty()) return closeTake(options);
    if (!options.resimulated.empty()) return resimulateTake(options);
    if (!options.shaped.empty())
        return withOutputs({{options.output, content::kProject}}, [&] { return shapeOfTake(options); });
    if (!options.exported.empty()) {
        if (options.format.empty() || options.output.empty())
            throw WrongUsage("--export needs --format and -o", "--export NAME --format abc -o F.abc");
        const std::string_view kind = kindOfExport(options.format);
        return withOutputs(
            {{options.output, kind}}, [&] { return exportNamed(options); }, ReadBack::Yes);
    }
    if (!options.removed.empty()) {
        if (auto status = removeTake(options.simulation.input, options.removed); !status)
            return tl::unexpected(status.error());
        return listTakes(options);
    }
    if (!options.renamed.empty()) {
        if (options.renamed.size() != 2)
            throw WrongUsage("--rename is not two names", "expected --rename OLD NEW");
        if (auto status = renameTake(options.simulation.input, options.renamed[0], options.renamed[1]);
            !status)
            return tl::unexpected(status.error());
        return listTakes(options);
    }
    return options.compared.empty() ? listTakes(options) : distanceOfTakes(options);
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<TakesOptions>();
    job.add_option("groom", options->simulation.input, "Project or hair file")->required();
    auto* record = job.add_option("--record", options->record,
                                  "Simulate and keep the motion as a take of this name, in the folder "
                                  "GROOM.takes beside the groom");
    auto* exported = job.add_option("--export", options->exported, "Name of the take to export to -o");
    auto* removed = job.add_option("--delete", options->removed, "Name of the take to delete");
    auto* renamed = job.add_option("--rename", options->renamed, "Old and new name of a take")->expected(2);
    auto* compared =
        job.add_option("--compare", options->compared,
                       "Names of two takes of the same groom, to measure the distance between their points")
            ->expected(2);
    auto* closed = job.add_option("--close", options->closed,
                                  "Name of a take to make a loop of, under the name --to: the end of --range "
                                  "is blended into the frames before it");
    auto* resimulated = job.add_option(
        "--resimulate", options->resimulated,
        "Name of a take to keep up to the frame --at, and to simulate from there with the groom's settings "
        "and motion as they are now, under the name --to");
    auto* shaped =
        job.add_option("--shape", options->shaped,
                       "Name of a take whose frame --at becomes the authored shape that -o writes, "
                       "on the head at rest, as rods that carry their weight");
    const std::vector<CLI::Option*> ways{record,   exported, removed,     renamed,
                                         compared, closed,   resimulated, shaped};
    for (CLI::Option* one : ways) {
        for (CLI::Option* other : ways) {
            if (one != other) one->excludes(other);
        }
    }
    const std::vector<CLI::Option*> shared = addSimulationOptions(job, options->simulation);
    for (CLI::Option* option : shared) {
        const std::string name = option->get_name();
        if (name != "--frames" && name != "--loop-blend" && name != "--loop-repeats" && name != "--character")
            option->needs(record);
    }
    job.add_option("--to", options->to, "Name of the take to make");
    job.add_option("--at", options->at, "Frame of the take, counted from 0")
        ->check(CLI::Range(0, 1'000'000'000));
    job.add_option("--format", options->format,
                   "frames is a record of simulate, runtime an asset whose clip a game plays without "
                   "simulating, webp an "
                   "animated image, mp4 a video. The others are formats of export with animation")
        ->check(CLI::IsMember(takeFormats()))
        ->needs(exported);
    job.add_option("--range", options->range,
                   "FIRST,LAST frame of the take to export (default: all) or to close (default: the last "
                   "repeat of the time line)")
        ->check(CLI::Range(0, 1'000'000'000))
        ->delimiter(',');
    job.add_flag("--loop", options->loops,
                 "Of a recording: as --loop of simulate. Of runtime: the clip loops, with its first frame "
                 "after the last, as that of a take that was recorded or closed as a loop does");
    job.add_option("--what", options->what,
                   "As --what of export, of formats of export with animation: guides, hairs or all")
        ->check(CLI::IsMember({"guides", "hairs", "all"}))
        ->needs(exported);
    job.add_option("--size", options->size, "Image size WxH of webp and mp4 in pixels")->needs(exported);
    job.add_option("--camera", options->camera, "Camera position of webp and mp4")
        ->check(CLI::IsMember({"front", "back", "left", "right", "three-quarter", "top", "bottom"}))
        ->needs(exported);
    job.add_option("-o,--output", options->output, "File to export to, or project of --shape");
    // An empty name says nothing of what to do.
    return [options, ways, &job](const std::string&) {
        checkTogether(*options, job);
        for (const CLI::Option* way : ways) {
            for (const std::string& name : way->results()) {
                if (auto path = takePath(options->simulation.input, name); !path)
                    throw WrongUsage(path.error());
            }
        }
        return runTakes(*options);
    };
}

}  // namespace

Job takesJob() {
    return {"takes", "Record what the simulation plays, and list, compare and export it",
            "hair.hairloom --record nod --motion nod --frames 120", declare};
}

}  // namespace hairloom::cli
