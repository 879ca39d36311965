// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/work_precision_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/file.h"
#include "core/charts/html_report.h"
#include "core/cost/machine.h"

namespace hairloom {
namespace {

using Cells = std::vector<std::string>;

struct NamedDrawing {
    std::string file;
    std::string svg;
};

Cells headOf(const WorkPrecision& result) {
    Cells head;
    for (const GridAxis& axis : result.options.axes) head.push_back(axis.field);
    return head;
}

Cells valuesOf(const WorkPrecision& result, const WorkPrecisionRun& run) {
    Cells cells;
    for (std::size_t a = 0; a < run.values.size(); ++a) {
        cells.push_back(axisValueText(result.options.axes[a], run.values[a]));
    }
    return cells;
}

double allStrandsMs(const WorkPrecision& result, const WorkPrecisionRun& run) {
    return run.milliseconds.median * static_cast<double>(result.groomStrands) /
           static_cast<double>(result.strands);
}

std::string joined(const Cells& cells) {
    return fmt::format("{}\n", fmt::join(cells, ","));
}

void append(Cells& cells, const Cells& more) {
    cells.insert(cells.end(), more.begin(), more.end());
}

using NumberText = std::string (*)(double number);
std::string forPeople(double number) {
    return fmt::format("{:.4f}", number);
}
std::string forPrograms(double number) {
    return fmt::format("{:.6g}", number);
}

/// Of steps, points and model; empty where they are not known.
Cells partsOf(const WorkPrecisionRun& run, NumberText text) {
    if (!run.parts) return {"", "", ""};
    return {text(run.parts->step.rmsMm), text(run.parts->points.rmsMm), text(run.parts->model.rmsMm)};
}

Cells otherErrorsOf(const WorkPrecisionRun& run, NumberText text) {
    const OtherErrors& other = run.other;
    Cells cells;
    for (const double number :
         {other.dropMm, other.returnMm, other.headDepthMm, other.sphereDepthMm, 1e3 * other.restSpeed})
        cells.push_back(text(number));
    return cells;
}

Cells rowForPeople(const WorkPrecision& result, const WorkPrecisionRun& run) {
    Cells cells = valuesOf(result, run);
    if (run.diverged) {
        cells.resize(cells.size() + 10);
        cells.push_back("diverged");
        return cells;
    }
    append(cells, {fmt::format("{:.4f}", run.milliseconds.median), fmt::format("{:.4f}", run.milliseconds.q1),
                   fmt::format("{:.4f}", run.milliseconds.q3), fmt::format("{:.4f}", run.error.rmsMm),
                   fmt::format("{:.3f}", run.error.maxMm)});
    append(cells, otherErrorsOf(run, forPeople));
    cells.push_back(run.onFront ? "on the front" : run.trembling > 0 ? "trembles at rest" : "");
    return cells;
}

Cells headForPeople(const WorkPrecision& result) {
    Cells head = headOf(result);
    append(head, {"ms", "first quartile", "third quartile", "error mm rms", "error mm max", "drop mm",
                  "after a shake mm", "in the head mm", "in spheres mm", "at rest mm/s", ""});
    return head;
}

void addFront(const WorkPrecision& result, HtmlReport& page) {
    std::vector<const WorkPrecisionRun*> front;
    for (const WorkPrecisionRun& run : result.runs) {
        if (run.onFront) front.push_back(&run);
    }
    std::ranges::sort(front, {}, [](const WorkPrecisionRun* run) { return run->milliseconds.median; });
    std::vector<Cells> rows{headForPeople(result)};
    rows.front().pop_back();
    append(rows.front(), {"of steps", "of points", "of the model"});
    for (const WorkPrecisionRun* run : front) {
        rows.push_back(rowForPeople(result, *run));
        rows.back().pop_back();
        append(rows.back(), partsOf(*run, forPeople));
    }
    page.heading("The Pareto front");
    page.paragraph("Settings that no other measured setting beats in both time and error, fastest first.");
    page.table(rows);
}

void addParts(const WorkPrecision& result, const std::string& drawing, HtmlReport& page) {
    page.heading("Sources of error");
    page.drawing(drawing);
    page.list(
        {fmt::format("Steps: difference from the same setting with up to {} substeps. Use more substeps to "
                     "reduce it.",
                     kConvergedSubsteps),
         "Points: difference from strands with twice as many points as the finest measured setting. Use more "
         "points to reduce it.",
         "Model: difference between the elastic rod and the finest strands of this model, with short steps. "
         "It comes from stretching springs, strands that follow a guide, contact and friction, hair-hair "
         "collision, single precision and a head sampled once per frame. More substeps or points do not "
         "reduce it.",
         fmt::format(
             "Uncertainty of the reference: it moves by {:.3g} mm when its resolution in time is halved. "
             "What is below that says little.",
             result.groundTruthUncertaintyMm)});
}

void addMeasures(const std::vector<NamedDrawing>& drawings, HtmlReport& page) {
    page.heading("Sag, penetration, rest");
    for (std::size_t m = 1; m < measures().size(); ++m) {
        page.paragraph(measures()[m].meaning);
        page.drawing(drawings[m].svg);
    }
}

/// "dampingTime 0.5 s, gravity 0 -9.81 0 m/s²": every setting that no axis varies.
std::string otherSettings(const WorkPrecision& result) {
    Cells settings;
    for (const auto& field : fieldsOf(result.settings)) {
        if (findAxis(result.options.axes, field.name)) continue;
        std::string text = field.name;
        if (field.kind == runtime::FieldKind::Ramp) {
            for (const auto& [at, value] : runtime::member<runtime::Ramp>(result.settings, field).inUse())
                text += fmt::format(" {:.6g}:{:.6g}", at, value);
        }
        for (std::uint32_t c = 0; c < field.components(); ++c) {
            const double value = runtime::fieldValue(result.settings, field, c);
            // A float's digits, not those of the double it is converted to.
            text += field.choices.empty()
                        ? fmt::format(" {:.6g}", value)
                        : fmt::format(" {}", field.choices[static_cast<std::size_t>(value)]);
        }
        settings.push_back(fmt::format("{}{}{}", text, *field.unit ? " " : "", field.unit));
    }
    return fmt::format("{}", fmt::join(settings, ", "));
}

void addWhatWasRun(const WorkPrecision& result, const ReportContext& context, HtmlReport& page) {
    const WorkPrecisionOptions& options = result.options;
    const Machine machine = thisMachine();
    page.heading("What was run");
    std::vector<std::pair<std::string, std::string>> facts{
        {"Groom", context.groom},
        {"Strands", result.strands == result.groomStrands
                        ? fmt::format("all {}", result.strands)
                        : fmt::format("{} of {}, drawn with seed {}", result.strands, result.groomStrands,
                                      options.seed)},
        {"Motion", fmt::format("{}, {} frames at {:g} Hz, from rest", context.motion, options.time.frames,
                               options.time.framesPerSecond)}};
    for (const GridAxis& axis : options.axes) {
        Cells values;
        for (const double value : axis.values) values.push_back(axisValueText(axis, value));
        facts.emplace_back(axis.field, fmt::format("{}", fmt::join(values, ", ")));
    }
    facts.emplace_back("Other settings", otherSettings(result));
    facts.emplace_back(
        "Truth",
        fmt::format(
            "{}: {}, {} points per strand, {:.3g} mm root mean square from the same at twice the time step",
            result.groundTruthName, result.groundTruthDescription,
            result.groundTruthPoints ? fmt::format("{}", result.groundTruthPoints)
                                     : std::string("the authored"),
            result.groundTruthUncertaintyMm));
    if (!result.groundTruthDetail.empty()) facts.emplace_back("Its convergence", result.groundTruthDetail);
    if (result.strandsCompared < result.strands)
        facts.emplace_back("Strands compared", fmt::format("{}", result.strandsCompared));
    facts.emplace_back(
        "Error", fmt::format("distance of the same material points, {} evenly along each strand, at the "
                             "end of every frame",
                             options.pointsCompared));
    facts.emplace_back("Time",
                       fmt::format("of the engine, mean over the frames of a run; median and quartiles of {} "
                                   "runs after an untimed one, in rounds over all settings{}",
                                   options.repeats,
                                   findAxis(options.axes, kEngineAxis)
                                       ? "; of a GPU from recording a frame to having its report"
                                       : ""));
    facts.emplace_back("Diverged", fmt::format("not finite, or an error above {:.4g} mm root mean square",
                                               options.divergedAboveMm));
    facts.emplace_back(
        "Machine",
        fmt::format("{} hardware threads, {} used{}, instruction set {}", machine.cores, machine.threads,
                    findAxis(options.axes, kThreadsAxis) ? " unless threads vary" : "",
                    machine.instructionSet));
    page.facts(facts);
    if (!context.commandLine.empty()) page.command(context.commandLine);
}

void addAllRuns(const WorkPrecision& result, HtmlReport& page) {
    std::vector<Cells> rows{headForPeople(result)};
    std::vector<bool> strong;
    for (const WorkPrecisionRun& run : result.runs) {
        rows.push_back(rowForPeople(result, run));
        strong.push_back(run.onFront);
    }
    page.heading("All runs");
    page.table(rows, strong);
}

void addPeers(const std::vector<PeerRun>& peers, HtmlReport& page) {
    if (peers.empty()) return;
    std::vector<Cells> rows{{"simulator", "setting", "ms", "error mm rms", "error mm max", "stretch %",
                             "cantilever error mm", "its reference", "uncertain by mm", "measured"}};
    for (const PeerRun& run : peers)
        rows.push_back({fmt::format("{} {}", run.name, run.version), run.setting,
                        fmt::format("{:.4g}", run.milliseconds), fmt::format("{:.4g}", run.errorMm),
                        fmt::format("{:.4g}", run.errorMaxMm), fmt::format("{:.4g}", run.stretchPercent),
                        fmt::format("{:.4g}", run.cantileverMm), run.reference,
                        fmt::format("{:.3g}", run.referenceUncertaintyMm),
                        fmt::format("{}, {}, load {:g}", run.machine, run.date, run.load)});
    page.heading("Other simulators");
    page.paragraph(
        fmt::format("Not this hairstyle: {}. Compare their rows with each other, and ours among them "
                    "with the front above to see how this machine and hairstyle differ.",
                    peerScene()));
    page.table(rows);
}

constexpr const char* kPartsDrawing = "error_parts.svg";

std::vector<NamedDrawing> drawingsOf(const WorkPrecision& result, const ReportContext& context) {
    std::vector<NamedDrawing> drawings;
    for (const MeasureInfo& info : measures()) {
        const char* name = info.measure == Measure::distance ? "work_precision" : info.name;
        drawings.push_back(
            {fmt::format("{}.svg", name), svg(workPrecisionPlot(result, context, info.measure))});
    }
    if (const auto parts = partsPlot(result)) drawings.push_back({kPartsDrawing, svg(*parts)});
    for (std::size_t a = 0; a < result.options.axes.size(); ++a) {
        if (const auto plot = errorPlot(result, a)) {
            drawings.push_back({fmt::format("error_vs_{}.svg", result.options.axes[a].field), svg(*plot)});
        }
    }
    return drawings;
}

std::string pageOf(const WorkPrecision& result, const ReportContext& context,
                   const std::vector<NamedDrawing>& drawings) {
    HtmlReport page("Work and precision of " + context.groom);
    page.paragraph(
        "What one simulation frame costs for each setting of a grid, and how accurate the hair is.");
    page.drawing(drawings[0].svg);
    if (!result.notes.empty()) {
        page.heading("Notes");
        page.list(result.notes);
    }
    addFront(result, page);
    std::size_t next = measures().size();
    if (next < drawings.size() && drawings[next].file == kPartsDrawing)
        addParts(result, drawings[next++].svg, page);
    addMeasures(drawings, page);
    if (next < drawings.size()) page.heading("One setting at a time");
    for (; next < drawings.size(); ++next) page.drawing(drawings[next].svg);
    addPeers(context.peers, page);
    addWhatWasRun(result, context, page);
    addAllRuns(result, page);
    return page.html();
}

}  // namespace

std::string workPrecisionCsv(const WorkPrecision& result) {
    Cells head = headOf(result);
    append(head, {"ms_median", "ms_q1", "ms_q3", "ms_all_strands", "error_mm_rms", "error_mm_max", "drop_mm",
                  "after_shake_mm", "head_depth_mm", "sphere_depth_mm", "rest_speed_mm_s", "step_error_mm",
                  "points_error_mm", "model_error_mm", "diverged", "on_front"});
    std::string text = joined(head);
    for (const WorkPrecisionRun& run : result.runs) {
        Cells cells = valuesOf(result, run);
        if (run.diverged) {
            cells.resize(cells.size() + 14);
            append(cells, {"1", "0"});
        } else {
            for (const double number : {run.milliseconds.median, run.milliseconds.q1, run.milliseconds.q3,
                                        allStrandsMs(result, run), run.error.rmsMm, run.error.maxMm}) {
                cells.push_back(forPrograms(number));
            }
            append(cells, otherErrorsOf(run, forPrograms));
            append(cells, partsOf(run, forPrograms));
            append(cells, {"0", run.onFront ? "1" : "0"});
        }
        text += joined(cells);
    }
    return text;
}

Result<std::vector<std::string>> writeWorkPrecision(const WorkPrecision& result, const ReportContext& context,
                                                    const std::filesystem::path& folder) {
    const std::vector<NamedDrawing> drawings = drawingsOf(result, context);
    std::vector<std::pair<std::string, std::string>> files{{"data.csv", workPrecisionCsv(result)}};
    for (const NamedDrawing& drawing : drawings) files.emplace_back(drawing.file, drawing.svg);
    files.emplace_back("report.html", pageOf(result, context, drawings));
    return writeFiles(folder, files);
}

}  // namespace hairloom
