// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

#include "cli/body_notes.h"
#include "cli/card_options.h"
#include "cli/colour_options.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/write_rules.h"
#include "core/documents/hair_export.h"
#include "core/documents/web_page.h"
#include "core/stability/certificate.h"

namespace hairloom::cli {
namespace {

struct ExportOptions {
    std::string input;
    std::string format;
    std::string target;
    std::string what = "guides";
    std::vector<std::string> layers;    ///< names; empty: all
    std::string record;                 ///< of simulate; empty: at rest
    std::vector<std::uint64_t> frames;  ///< first and last; with the handles behind addHandles()
    std::uint64_t handles = 0;
    std::optional<double> start;  ///< number in the file of the first frame without handles
    double framesPerSecond = 0;   ///< of the file; 0: of the record
    std::string shutter;          ///< "OPEN:CLOSE"; empty: none
    std::uint32_t samples = 3;
    bool physics = false;
    std::string unit;
    std::string up;
    std::uint32_t points = 0;
    bool certify = false;
    LevelBudget levels;
    colour::ColourChoice colours;  ///< of a web page
    std::string output;
};

/// Beside the asset; a device has no report.
std::string companionOf(const std::string& output) {
    std::error_code code;
    const auto type = std::filesystem::status(output, code).type();
    const bool file =
        type == std::filesystem::file_type::regular || type == std::filesystem::file_type::not_found;
    return file ? output + ".report.json" : std::string();
}

/// "abc, usda": names of the formats that are `wanted`.
template <class Wanted>
std::string formatsWhere(Wanted&& wanted) {
    std::string formats;
    for (const HairWriter& writer : hairWriters()) {
        if (wanted(writer)) formats += (formats.empty() ? "" : ", ") + writer.name;
    }
    return formats;
}

/// Format and target as they were asked for; where one is not said, as the other has it best.
struct Asked {
    const HairWriter* writer;
    const ExportTarget* target;
};
Result<Asked> findAsked(const ExportOptions& options) {
    if (options.format.empty() && options.target.empty())
        throw WrongUsage("neither --format nor --target is given", "expected one of them");
    const HairWriter& writer = options.format.empty() ? preferredWriter(options.target, hairWriters())
                                                      : strandWriter(options.format, hairWriters());
    if (options.target.empty()) return Asked{&writer, &writer.targets.front()};
    const ExportTarget* const target = findTarget(writer, options.target);
    if (target != nullptr) return Asked{&writer, target};
    throw WrongUsage(fmt::format("{} does not read {}", options.target, options.format),
                     "expected " + formatsWhere([&](const HairWriter& other) {
                         return findTarget(other, options.target) != nullptr;
                     }));
}

/// Throws WrongUsage where one of the options is given with a format that has no cards.
void checkCardOptions(const ExportOptions& options, const std::vector<const CLI::Option*>& ofCards) {
    const auto given = std::ranges::find_if(ofCards, [](const auto* option) { return option->count() > 0; });
    if (given == ofCards.end()) return;
    const bool isPage = options.format == kWebFormat;
    if (!isPage && findAsked(options)->writer->holdsCards()) return;
    throw WrongUsage(
        fmt::format("{} applies to cards alone", (*given)->get_name()),
        "expected it with --format " + formatsWhere([](const HairWriter& w) { return w.holdsCards(); }));
}

/// Throws WrongUsage where options ask for what a format does not have.
void checkFormat(const HairWriter& writer, const ExportOptions& options,
                 const StrandExportOptions& exporting) {
    if (writer.holdsCards() &&
        (exporting.metresPerUnit != 1 || exporting.up != UpAxis::Y || exporting.pointsPerStrand > 0))
        throw WrongUsage(
            "--output-unit, --up and --points do not apply to cards",
            "leave them out: glTF, OBJ and USD of cards are in metres, FBX in centimetres, Y up");
    if (options.what == "all" && !writer.marksGuides && !writer.keepsGuides)
        throw WrongUsage(
            fmt::format("{} does not keep guides apart from hairs, as --what all has them", writer.name),
            "expected --format " +
                formatsWhere([](const HairWriter& w) { return w.marksGuides || w.keepsGuides; }));
    if (options.physics && (!writer.holdsPhysics || !options.record.empty()))
        throw WrongUsage("--physics applies to hair at rest in USD",
                         "expected it without --record, and with --format " +
                             formatsWhere([](const HairWriter& w) { return w.holdsPhysics; }));
    if (!options.shutter.empty() && !writer.animates)
        throw WrongUsage(fmt::format("{} holds a single pose, and --shutter asks for several", writer.name),
                         "expected --format " + formatsWhere([](const HairWriter& w) { return w.animates; }));
    if (options.frames.size() != 2 || options.frames[1] <= options.frames[0] || writer.animates) return;
    throw WrongUsage(
        fmt::format("{} holds a single pose, and --frames asks for several", writer.name),
        "expected one frame, or --format " + formatsWhere([](const HairWriter& w) { return w.animates; }));
}

/// Writes the report beside the file, if that is one.
Result<Report> withCompanion(const ExportOptions& options, Report report) {
    const std::string companion = companionOf(options.output);
    if (companion.empty()) return report;
    if (auto saved = writeFileAtomically(companion, std::string_view(report.dump(2) + "\n")); !saved)
        return tl::unexpected(saved.error());
    return report;
}

/// Frames of the record at both ends of those that were asked for, as far as there are some.
Status addFramesAround(const ExportOptions& options, const Groom& groom, HairToExport& wanted) {
    MotionSampling sampling;
    sampling.recordRate = static_cast<double>(wanted.frames.front().framesPerSecond);
    sampling.framesPerSecond = options.framesPerSecond > 0 ? options.framesPerSecond : sampling.recordRate;
    sampling.shutter = wanted.shutter;
    const std::uint64_t reach = framesAround(sampling);
    const std::uint64_t first = options.frames[0] - std::min(reach, options.frames[0]);
    const std::uint64_t last = std::min(options.frames[1] + reach, wanted.frames.front().framesInRecord - 1);
    std::vector<RecordedFrame> before;
    for (std::uint64_t number = first; number <= last; ++number) {
        if (number >= options.frames[0] && number <= options.frames[1]) continue;
        auto frame = readFrame(options.record, groom, number);
        if (!frame) return tl::unexpected(frame.error());
        (number < options.frames[0] ? before : wanted.frames).push_back(std::move(*frame));
    }
    wanted.framesBefore = before.size();
    wanted.framesAfter = last - options.frames[1];
    wanted.frames.insert(wanted.frames.begin(), std::make_move_iterator(before.begin()),
                         std::make_move_iterator(before.end()));
    return {};
}

/// The frames with those of the handles. Throws WrongUsage where they begin before the record.
void addHandles(ExportOptions& options) {
    if (options.handles == 0 || options.frames.size() != 2 || options.frames[1] < options.frames[0]) return;
    if (options.handles > options.frames[0])
        throw WrongUsage(
            fmt::format("--handles {} before frame {} begins before the record", options.handles,
                        options.frames[0]),
            fmt::format("expected --frames from {} on, as simulate --handles leaves them", options.handles));
    options.frames[0] -= options.handles;
    options.frames[1] += options.handles;
}

Result<HairToExport> hairToExport(const ExportOptions& options, const Groom& groom) {
    HairToExport wanted;
    wanted.hair = options.what == "all"     ? ExportedHair::all
                  : options.what == "hairs" ? ExportedHair::hairs
                                            : ExportedHair::guides;
    wanted.layers = options.layers;
    wanted.levels = options.levels;
    if (options.certify) wanted.storms = CertificateOptions{}.storms;
    if (options.record.empty()) return wanted;
    if (options.frames.size() != 2 || options.frames[1] < options.frames[0])
        throw WrongUsage("--frames runs backwards or is not two numbers", "FIRST,LAST");
    if (!options.shutter.empty()) {
        const auto shutter = shutterFrom(options.shutter, options.samples);
        if (!shutter) throw WrongUsage(shutter.error().problem, shutter.error().expected);
        wanted.shutter = *shutter;
    }
    wanted.framesPerSecond = options.framesPerSecond;
    for (std::uint64_t number = options.frames[0]; number <= options.frames[1]; ++number) {
        auto frame = readFrame(options.record, groom, number);
        if (!frame) return tl::unexpected(frame.error());
        wanted.frames.push_back(std::move(*frame));
    }
    const auto rate = static_cast<double>(wanted.frames.front().framesPerSecond);
    const double perFrame = options.framesPerSecond > 0 ? options.framesPerSecond / rate : 1;
    const double handles = static_cast<double>(options.handles) * perFrame;
    if (std::abs(handles - std::round(handles)) > 1e-6)
        throw WrongUsage(
            fmt::format("--handles {} end between frames of the file, at {:g} in place of {:g} a second",
                        options.handles, options.framesPerSecond, rate),
            fmt::format("expected handles that are whole frames at {:g} a second", options.framesPerSecond));
    wanted.firstFrame = options.start ? *options.start - std::round(handles)
                                      : std::round(static_cast<double>(options.frames[0]) * perFrame);
    if (options.shutter.empty() && perFrame == 1) return wanted;
    if (auto status = addFramesAround(options, groom, wanted); !status) return tl::unexpected(status.error());
    return wanted;
}

/// Throws WrongUsage where one of the options is given with a format that has no colours of a display.
void checkColourOptions(const ExportOptions& options) {
    const colour::ColourChoice none;
    if (options.format == kWebFormat || options.colours == none) return;
    throw WrongUsage("--color-config, --display and --view-transform apply to a web page alone",
                     fmt::format("expected them with --format {}", kWebFormat));
}

Result<Report> exportAsPage(const ExportOptions& options) {
    if (!options.target.empty() || !options.unit.empty() || options.up == "z" || options.points > 0 ||
        !options.record.empty() || options.what != "guides" || options.physics)
        throw WrongUsage(
            "--target, --output-unit, --up, --points, --record, --physics and --what do not apply to a web "
            "page",
            "leave them out: the page plays a runtime asset in metres, Y up, which draws follow hairs "
            "itself");
    const auto colours = colour::chooseColours(options.colours);
    if (!colours) return tl::unexpected(colours.error());
    const auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    HairToExport wanted;
    wanted.layers = options.layers;
    if (options.certify) wanted.storms = CertificateOptions{}.storms;
    const auto* const view = *colours ? (*colours)->toDisplay.get() : nullptr;
    const auto written = exportWebPage(*groom, wanted, options.output, view);
    if (!written) return tl::unexpected(inFile(written.error(), options.input));
    tellFindings(written->findings);
    Report report = toJson(*written);
    if (!*colours) return report;
    report["color"] = colourReport(**colours);
    const std::string& note = (*colours)->config.working().note;
    if (!note.empty()) reportNotes({note}, report);
    return report;
}

Result<Report> exportAsset(const ExportOptions& options) {
    const auto asked = findAsked(options);
    if (!asked) return tl::unexpected(asked.error());
    const auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    StrandExportOptions exporting = asked->target->options;
    if (!options.unit.empty()) exporting.metresPerUnit = metresPerUnit(options.unit);
    if (!options.up.empty()) exporting.up = options.up == "z" ? UpAxis::Z : UpAxis::Y;
    if (options.points > 0) exporting.pointsPerStrand = options.points;
    exporting.physics = options.physics;
    checkFormat(*asked->writer, options, exporting);
    auto wanted = hairToExport(options, *groom);
    if (!wanted) return tl::unexpected(wanted.error());
    Progress bar("exporting", 1000);
    wanted->progress = [&](std::string_view, double share) {
        bar.done(static_cast<std::size_t>(1000 * share));
    };
    const auto written = exportHair(*groom, *wanted, *asked->writer, options.output, exporting);
    if (!written) return tl::unexpected(inFile(written.error(), options.input));
    tellFindings(written->findings);
    return withCompanion(options, toJson(*written));
}

std::vector<std::string> formatNames() {
    std::vector<std::string> names;
    for (const HairWriter& writer : hairWriters()) names.push_back(writer.name);
    names.emplace_back(kWebFormat);
    return names;
}

/// A line for each.
std::string formatsInWords() {
    constexpr int kColumn = 16;
    std::string text = "File format";
    for (const HairWriter& writer : hairWriters())
        text += fmt::format("\n{:<{}}{}", writer.name, kColumn, writer.label);
    text += fmt::format("\n{:<{}}A folder with a web page that plays the hair", kWebFormat, kColumn);
    return text;
}

std::string targetsInWords() {
    constexpr int kColumn = 16;
    std::string text =
        "Program to export for. Sets unit, axis, points and limits, and the format unless "
        "--format is given";
    for (const std::string& program : exportPrograms(hairWriters())) {
        const HairWriter& writer = preferredWriter(program, hairWriters());
        text += fmt::format("\n{:<{}}{}", program, kColumn,
                            writer.holdsCards() ? writer.label : findTarget(writer, program)->note);
    }
    return text;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<ExportOptions>();
    job.add_option("groom", options->input, "Groom to export")->required();
    job.add_option("--format", options->format, formatsInWords())->check(CLI::IsMember(formatNames()));
    job.add_option("--target", options->target, targetsInWords())
        ->check(CLI::IsMember(exportPrograms(hairWriters())));
    job.add_option(
           "--what", options->what,
           "guides: the strands of the groom; hairs: the follow hairs that images show, in abc-unreal with "
           "their guides, which Unreal needs; all: these with their guides beside them, in formats that "
           "keep them apart")
        ->check(CLI::IsMember({"guides", "hairs", "all"}));
    job.add_option("--layers", options->layers, "Names of the layers to export (default: all)")
        ->delimiter(',');
    auto* record = job.add_option("--record", options->record,
                                  "Frames written by simulate --record, instead of the rest pose");
    auto* frames =
        job.add_option("--frames", options->frames,
                       "FIRST,LAST of the record: exports animated strands, in formats with animation")
            ->check(CLI::Range(0, 1'000'000'000))
            ->delimiter(',')
            ->needs(record);
    record->needs(frames);
    job.add_option("--handles", options->handles,
                   "Number of frames of the record to export before and behind --frames as well")
        ->check(CLI::Range(0, 1000))
        ->needs(record);
    job.add_option("--start", options->start,
                   "Number of FIRST in the file, as 1001 (default: its number in the record)")
        ->check(CLI::Range(-1e6, 1e6))
        ->needs(record);
    job.add_option("--fps", options->framesPerSecond,
                   "Frames per second of the file (default: those of the record)")
        ->check(CLI::Range(1.0, 1000.0))
        ->needs(record);
    auto* shutter =
        job.add_option("--shutter", options->shutter,
                       "OPEN:CLOSE in frames, as -0.25:0.25: samples within each frame, for motion blur")
            ->needs(record);
    job.add_option("--samples", options->samples, "Number of samples while the shutter is open")
        ->check(CLI::Range(2u, kMaxShutterSamples))
        ->needs(shutter);
    job.add_flag("--physics", options->physics,
                 "USD: deformable curves for simulators, of the guides or all strands "
                 "(PhysicsCurvesDeformableSimAPI)");
    job.add_option("--output-unit", options->unit,
                   "Unit of lengths in the file that is written (default: that of --target, or metres)")
        ->check(CLI::IsMember(unitNames()));
    job.add_option("--up", options->up, "Up axis of the file")->check(CLI::IsMember({"y", "z"}));
    job.add_option("--points", options->points,
                   "Resample every strand to this number of points. 0 keeps them")
        ->check(CLI::Range(0, 1024));
    job.add_flag("--certify", options->certify,
                 "Find out with a thousand random storms what a game may do to this hair, for the report and "
                 "the runtime asset. Takes about half a minute");
    const auto ofCards = addCardOptions(job, options->levels);
    addColourOptions(job, options->colours);
    job.add_option("-o,--output", options->output,
                   "File to write, or the folder of a web page. The report goes next to a file")
        ->required();
    return [options, ofCards](const std::string&) {
        checkLevels(options->levels);
        addHandles(*options);
        checkCardOptions(*options, ofCards);
        checkColourOptions(*options);
        if (options->format == kWebFormat)
            return withOutputFolder(options->output, {"hair.hairrt", "hair.js", "index.html"},
                                    [&] { return exportAsPage(*options); });
        const auto asked = findAsked(*options);
        if (!asked) return Result<Report>(tl::unexpected(asked.error()));
        const std::string companion = companionOf(options->output);
        // Known before it is read: it is no target, of whatever kind.
        noteInput(options->input);
        return withOutputs(
            {{options->output, contentKindOfSuffix(asked->writer->suffix())}, {companion, content::kJson}},
            [&] { return exportAsset(*options); }, ReadBack::Yes);
    };
}

}  // namespace

Job exportJob() {
    return {"export", "Export to another program, read the file back and compare",
            "hair.hairloom --format tfx -o hair.tfx", declare};
}

}  // namespace hairloom::cli
