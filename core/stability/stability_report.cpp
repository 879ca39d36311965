// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/stability_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/file.h"
#include "core/charts/html_report.h"

namespace hairloom {
namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string result(1, '"');
    for (const char c : text) {
        if (c == '"') result += c;
        result += c;
    }
    result += '"';
    return result;
}

std::vector<std::string> integratorsOf(const std::vector<StabilityResult>& results) {
    std::vector<std::string> names;
    for (const StabilityResult& r : results) {
        if (std::ranges::find(names, r.integrator) == names.end()) names.push_back(r.integrator);
    }
    return names;
}

const char* meaningOf(int number) {
    const auto found = std::ranges::find(hardCases(), number, &HardCase::number);
    return found == hardCases().end() ? "" : found->scene;
}

void addCases(const std::vector<StabilityResult>& results, HtmlReport& page) {
    std::vector<std::vector<std::string>> rows{
        {"case", "scene", "integrator", "substeps", "result", "deciding threshold"}};
    std::vector<bool> strong;
    for (const StabilityResult& r : results) {
        rows.push_back({fmt::format("{} {}", r.number, r.name), meaningOf(r.number), r.integrator,
                        std::to_string(r.substeps), verdict(r), decidingThreshold(r)});
        strong.push_back(r.claimed && !r.pass);
    }
    page.heading("Cases");
    page.table(rows, strong);
}

void addLimits(const std::vector<StabilityResult>& results, HtmlReport& page) {
    std::vector<std::vector<std::string>> rows{{"case", "integrator", "fails at substep", "theory"}};
    for (const StabilityResult& r : results) {
        if (r.claimed) continue;
        rows.push_back({fmt::format("{} {}", r.number, r.name), r.integrator,
                        r.failedAt ? std::to_string(*r.failedAt) : std::string("never"), r.limit});
    }
    if (rows.size() == 1) return;
    page.heading("Limits");
    page.table(rows);
}

std::string pageOf(const std::vector<StabilityResult>& results, const std::vector<StabilityMap>& maps,
                   const std::string& commandLine) {
    HtmlReport page("Stability of the strand engine");
    if (!commandLine.empty()) page.command(commandLine);
    const auto failed = std::ranges::count_if(results, [](const auto& r) { return r.claimed && !r.pass; });
    page.paragraph(
        fmt::format("{} cases, {} of them fail what their integrator claims.", results.size(), failed));
    addCases(results, page);
    addLimits(results, page);
    if (!maps.empty()) page.heading("Maps");
    for (const StabilityMap& map : maps) page.drawing(svg(stabilityPlot(map)));
    return page.html();
}

}  // namespace

std::string decidingThreshold(const StabilityResult& result) {
    const StabilityThreshold& m = result.closest();
    return fmt::format("{} {:.3g} of {:.3g}{}{}", m.what, m.worst, m.threshold, m.unit.empty() ? "" : " ",
                       m.unit);
}

std::string verdict(const StabilityResult& result) {
    if (result.claimed) return result.pass ? "pass" : "FAIL";
    if (result.failedAt) return fmt::format("limit, at substep {}", *result.failedAt);
    return result.pass ? "held" : fmt::format("limit: {}", decidingThreshold(result));
}

std::string stabilityCsv(const std::vector<StabilityResult>& results) {
    std::string text =
        "number,case,family,integrator,substeps,claimed,pass,measured,worst,threshold,unit,failed_at,"
        "limit\r\n";
    for (const StabilityResult& r : results) {
        for (const StabilityThreshold& m : r.thresholds) {
            text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", r.number, quoted(r.name),
                                quoted(r.family), r.integrator, r.substeps, r.claimed ? 1 : 0,
                                m.met() ? 1 : 0, quoted(m.what),
                                std::isfinite(m.worst) ? fmt::format("{:.6g}", m.worst) : "", m.threshold,
                                m.unit, r.failedAt ? std::to_string(*r.failedAt) : "", quoted(r.limit));
        }
    }
    return text;
}

std::string stabilityMarkdown(const std::vector<StabilityResult>& results) {
    const std::vector<std::string> integrators = integratorsOf(results);
    std::string text = "| case |", rule = "|---|";
    for (const std::string& name : integrators) {
        text += fmt::format(" {} |", name);
        rule += "---|";
    }
    text += fmt::format("\n{}\n", rule);
    for (std::size_t i = 0; i < results.size(); i += integrators.size()) {
        text += fmt::format("| {} {} |", results[i].number, results[i].name);
        for (std::size_t k = 0; k < integrators.size(); ++k) {
            const StabilityResult& r = results[i + k];
            text += fmt::format(" {}", verdict(r));
            if (!r.failedAt && r.substeps != runtime::SimulationSettings{}.substeps &&
                r.substeps != runtime::kSpringSubsteps)
                text += fmt::format(" ({} substeps)", r.substeps);
            if (r.claimed && !r.pass) text += fmt::format(": {}", decidingThreshold(r));
            text += " |";
        }
        text += "\n";
    }
    return text;
}

Result<std::vector<std::string>> writeStability(const std::vector<StabilityResult>& results,
                                                const std::vector<StabilityMap>& maps,
                                                const std::string& commandLine,
                                                const std::filesystem::path& folder) {
    std::vector<std::pair<std::string, std::string>> files{{"cases.csv", stabilityCsv(results)},
                                                           {"cases.md", stabilityMarkdown(results)}};
    for (const StabilityMap& map : maps) {
        files.emplace_back(fmt::format("stability-{}-{}.svg", nameOf(map.integrator), forceName(map.force)),
                           svg(stabilityPlot(map)));
    }
    files.emplace_back("report.html", pageOf(results, maps, commandLine));
    return writeFiles(folder, files);
}

}  // namespace hairloom
