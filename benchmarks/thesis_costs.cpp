// SPDX-License-Identifier: GPL-3.0-or-later
// Table 3 of the thesis (Rünz 2012, Section 7.2) on this machine, with springs as there and with rods.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "benchmarks/sim.h"

namespace hairloom::benchmarks {
namespace {

using runtime::StrandModel;

const char* nameOf(StrandModel model) {
    return model == StrandModel::rods ? "rods" : "springs";
}

void measureColumn(ThesisCosts& column, int repetitions, double seconds) {
    // Springs keep the names that they have had since before there were rods.
    const std::string setup = fmt::format("{}{} guides of {} segments with {} neighbours",
                                          column.model == StrandModel::rods ? "rods, " : "", column.guides,
                                          kThesisSegments, column.neighbours);
    for (std::size_t i = 0; i < kFamilies.size(); ++i)
        column.measured[i] = {fmt::format("Table 3, {}, {}", kFamilies[i], setup), "ms", {}};
    column.whole = {fmt::format("Table 3, step and interpolation, {}", setup), "ms", {}};
    StepRun run(
        {.strands = column.guides, .points = kThesisSegments + 1, .model = column.model, .byStage = true});
    const scenes::Lawn lawn(column.guides, column.neighbours + 1, kThesisSegments + 1, 0.0f);
    auto made = runtime::FollowHairs::make(lawn.view());
    const std::uint32_t frames = run.framesFor(seconds);
    for (int r = 0; r < repetitions; ++r) {
        const double step = run.milliseconds(frames);
        std::array<double, kFamilies.size()> sums{};
        for (std::size_t i = 0; i < runtime::kStageCount; ++i) {
            const auto family = std::ranges::find(
                kFamilies, std::string_view(runtime::stageFamily(static_cast<runtime::StageId>(i))));
            sums[static_cast<std::size_t>(family - kFamilies.begin())] += run.stageMilliseconds()[i];
        }
        sums.back() = followMilliseconds(*made.hairs, lawn, false, frames);
        for (std::size_t i = 0; i < sums.size(); ++i) column.measured[i].values.push_back(sums[i]);
        column.whole.values.push_back(step + sums.back());
    }
}

double sumOf(const std::array<double, kFamilies.size()>& printed) {
    double sum = 0;
    for (const double milliseconds : printed) sum += milliseconds;
    return sum;
}

}  // namespace

std::vector<ThesisCosts> measureThesisCosts(int repetitions, double seconds) {
    // In the order of kFamilies.
    std::vector<ThesisCosts> columns;
    for (const StrandModel model : {StrandModel::springs, StrandModel::rods}) {
        columns.push_back(
            {model, 100, 30, {0.1973, 1.2046, 0.0542, 0.3124, 0.1094, 0.8614, 0.0108, 0.7276}, {}, {}});
        columns.push_back(
            {model, 200, 30, {0.3985, 2.4012, 0.1100, 0.6269, 0.2159, 1.6741, 0.0201, 1.4497}, {}, {}});
        columns.push_back(
            {model, 300, 30, {0.5907, 3.6037, 0.1652, 0.9403, 0.3441, 2.5928, 0.0288, 2.1637}, {}, {}});
        columns.push_back(
            {model, 300, 60, {0.5935, 3.6015, 0.1686, 0.9417, 0.3561, 2.6141, 0.0337, 4.1803}, {}, {}});
    }
    for (ThesisCosts& column : columns) measureColumn(column, repetitions, seconds);
    return columns;
}

std::string thesisTable(const std::vector<ThesisCosts>& columns) {
    std::string text;
    const auto out = std::back_inserter(text);
    for (const StrandModel model : {StrandModel::springs, StrandModel::rods}) {
        std::vector<const ThesisCosts*> shown;
        for (const ThesisCosts& column : columns) {
            if (column.model == model) shown.push_back(&column);
        }
        if (shown.empty()) continue;
        const bool isRods = model == StrandModel::rods;
        fmt::format_to(
            out,
            "\n## Table 3 of the thesis, {}\n\nMilliseconds per frame on one thread: Rünz 2012, Section 7.2 "
            "(Core i7-920, springs), then this machine, then how many times faster. {} segments a guide, {} "
            "substeps, wind and ten spheres.{}\n\n| |",
            nameOf(model), kThesisSegments,
            isRods ? runtime::SimulationSettings{}.substeps : runtime::kSpringSubsteps,
            isRods ? " Rods solve all forces, lengths and contacts of a strand at once: that is integration."
                   : "");
        std::string rule = "|---|";
        for (const ThesisCosts* column : shown) {
            fmt::format_to(out, " {} guides, {} neighbours |", column->guides, column->neighbours);
            rule += "---|";
        }
        fmt::format_to(out, "\n{}\n", rule);
        const auto cell = [&](double printed, double measured) {
            if (measured > 0)
                fmt::format_to(out, " {:.3f} → {:.3f} ({:.3g}×) |", printed, measured, printed / measured);
            else
                fmt::format_to(out, " {:.3f} → – |", printed);
        };
        for (std::size_t i = 0; i < kFamilies.size(); ++i) {
            const bool none = std::ranges::all_of(
                shown, [&](const ThesisCosts* column) { return column->measured[i].median() == 0; });
            if (none) continue;
            fmt::format_to(out, "| {} |", kFamilies[i]);
            for (const ThesisCosts* column : shown) cell(column->printed[i], column->measured[i].median());
            fmt::format_to(out, "\n");
        }
        fmt::format_to(out, "| **all of these; here the whole step and interpolation** |");
        for (const ThesisCosts* column : shown) cell(sumOf(column->printed), column->whole.median());
        fmt::format_to(out, "\n");
    }
    return text;
}

}  // namespace hairloom::benchmarks
