// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/picture_cost_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/output_file.h"
#include "core/charts/html_report.h"

namespace hairloom {
namespace {

/// A picture that is the right one to the byte has no place on a logarithmic axis; that is where it stands.
constexpr double kLeastFlip = 1e-4;

std::string tooltipOf(const PictureCostRun& run) {
    return fmt::format("{} {}: {:.3g} ms, FLIP {:.3g}, light {:.3g}", run.setting, run.value,
                       run.milliseconds.median, run.flip, run.light);
}

std::string pageOf(const PictureCost& cost, const std::string& groom, const std::string& commandLine,
                   const std::string& drawing) {
    HtmlReport page("Cost of render settings for " + groom + " costs");
    page.paragraph(
        "Each setting at other values while all others stay the same: the time of one frame of moving hair, "
        "and the difference from the best image of the same hair, light and view (FLIP, Andersson et al. "
        "2020, where 0 is identical).");
    page.drawing(drawing);
    if (!cost.notes.empty()) {
        page.heading("Notes");
        page.list(cost.notes);
    }
    std::vector<std::vector<std::string>> rows{
        {"setting", "value", "ms", "first quartile", "third quartile", "FLIP", "light"}};
    std::vector<bool> strong;
    for (const PictureCostRun& run : cost.runs) {
        rows.push_back({run.setting, run.value, fmt::format("{:.3f}", run.milliseconds.median),
                        fmt::format("{:.3f}", run.milliseconds.q1),
                        fmt::format("{:.3f}", run.milliseconds.q3), fmt::format("{:.4f}", run.flip),
                        fmt::format("{:.3f}", run.light)});
        strong.push_back(run.now);
    }
    page.heading("Settings");
    page.paragraph("Bold rows are the current settings. Light is relative to the reference image.");
    page.table(rows, strong);
    page.heading("What was drawn");
    page.facts({{"Groom", groom},
                {"Device", cost.device},
                {"Picture", fmt::format("{}×{}, {} of {} hairs, {} frames averaged in compared images",
                                        cost.width, cost.height, cost.hairs, cost.allHairs, cost.frames)}});
    if (!commandLine.empty()) page.command(commandLine);
    return page.html();
}

}  // namespace

std::string pictureCostCsv(const PictureCost& cost) {
    std::string text = "setting,value,now,ms_median,ms_q1,ms_q3,flip,light\n";
    for (const PictureCostRun& run : cost.runs) {
        text += fmt::format("{},{},{:d},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", run.setting, run.value,
                            run.now, run.milliseconds.median, run.milliseconds.q1, run.milliseconds.q3,
                            run.flip, run.light);
    }
    return text;
}

Plot pictureCostPlot(const PictureCost& cost, const std::string& groom) {
    Plot plot;
    plot.title = "Cost of the render settings";
    plot.note = fmt::format("{}, {} of {} hairs, {}×{}, on {}. The lines meet at the current settings.",
                            groom, cost.hairs, cost.allHairs, cost.width, cost.height, cost.device);
    plot.x = {.title = "a frame of moving hair", .unit = "ms", .scale = Scale::Logarithmic};
    plot.y = {.title = "difference from the reference image (FLIP)", .scale = Scale::Logarithmic};
    for (const PictureCostRun& run : cost.runs) {
        if (plot.series.empty() || plot.series.back().name != run.setting)
            plot.series.push_back({.name = run.setting, .line = LineStyle::Solid});
        plot.series.back().points.push_back({.x = run.milliseconds.median,
                                             .y = std::max(run.flip, kLeastFlip),
                                             .xLow = run.milliseconds.q1,
                                             .xHigh = run.milliseconds.q3,
                                             .label = run.now ? "" : run.value,
                                             .tooltip = tooltipOf(run)});
    }
    return plot;
}

Result<std::vector<std::string>> writePictureCost(const PictureCost& cost, const std::string& groom,
                                                  const std::string& commandLine,
                                                  const std::filesystem::path& folder) {
    const std::string drawing = svg(pictureCostPlot(cost, groom));
    return writeFiles(folder, {{"picture.csv", pictureCostCsv(cost)},
                               {"picture.svg", drawing},
                               {"report.html", pageOf(cost, groom, commandLine, drawing)}});
}

}  // namespace hairloom
