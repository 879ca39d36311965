// SPDX-License-Identifier: GPL-3.0-or-later
// The measurements of `bench sim` as Markdown.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "benchmarks/sim.h"

namespace hairloom::benchmarks {
namespace {

using Out = std::back_insert_iterator<std::string>;

/// Three digits that count.
std::string shortened(double value) {
    const double size = std::abs(value);
    return fmt::format("{:.{}f}", value, size >= 100.0 ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3);
}

std::string spread(const Measurement& m) {
    const auto [minimum, maximum] = std::ranges::minmax(m.values);
    return fmt::format("{} ({}…{})", shortened(m.median()), shortened(minimum), shortened(maximum));
}

void writeMachine(const SimulationBench& bench, const std::string& command, Out out) {
    const std::string processor = bench.machine.processor.empty() ? "unnamed" : bench.machine.processor;
    fmt::format_to(
        out,
        "# Measured\n\nWritten by `{}`.\ndocs/performance.md says what is measured and how. Medians of "
        "{} repetitions, in brackets the least and the greatest.\n\nProcessor: {}; {} hardware "
        "threads, {} in use; instruction set {}.\n",
        command, bench.steps.empty() ? 0 : bench.steps.front().step.values.size(), processor,
        bench.machine.cores, bench.machine.threads, bench.machine.instructionSet);
    for (const std::string& note : bench.notes) fmt::format_to(out, "\nNote: {}.\n", note);
}

/// What is laid down, and what this run says about it.
void writeWanted(const SimulationBench& bench, Out out) {
    fmt::format_to(out, "\n## Against what is wanted\n\n| what | measured | wanted | |\n|---|---|---|---|\n");
    for (const Wanted& other : bench.others) {
        if (!other.limit) continue;
        fmt::format_to(out, "| {} | {} {} | {} {:g} {} | {} |\n", other.cost.name, spread(other.cost),
                       other.cost.unit, other.atMost ? "at most" : "at least", *other.limit, other.cost.unit,
                       other.met() ? "met" : "**not met**");
    }
    for (const ThesisCosts& column : bench.thesis) {
        if (column.model != runtime::StrandModel::springs) continue;
        std::string slower;
        for (std::size_t i = 0; i < kFamilies.size(); ++i) {
            if (column.measured[i].median() <= column.printed[i]) continue;
            slower += fmt::format("{}{}", slower.empty() ? "" : ", ", kFamilies[i]);
        }
        fmt::format_to(
            out, "| Table 3, {} guides with {} neighbours | {} | every row faster than the thesis | {} |\n",
            column.guides, column.neighbours, slower.empty() ? "all faster" : "slower: " + slower,
            slower.empty() ? "met" : "**not met**");
    }
}

void writeSamples(const SimulationBench& bench, Out out) {
    fmt::format_to(
        out,
        "\n## A step of the samples\n\nNanoseconds per particle and substep, with each sample's own "
        "settings, on a nodding head; milliseconds are of a whole frame.\n\n| what | ns | ms per frame "
        "|\n|---|---|---|\n");
    for (const SampleStep& sample : bench.samples) {
        fmt::format_to(out, "| {} | {} | {} |\n", sample.step.name, spread(sample.step),
                       shortened(sample.step.median() * sample.work * 1e-6));
    }
}

void writeSteps(const SimulationBench& bench, Out out) {
    fmt::format_to(out,
                   "\n## A step\n\nNanoseconds per particle and substep, strands of 16 points with the "
                   "default settings; "
                   "milliseconds are of a whole frame.\n\n| strands | scene | threads | ns | ms per frame "
                   "|\n|---|---|---|---|---|\n");
    for (const StepCosts& costs : bench.steps) {
        const double work = static_cast<double>(costs.scene.strands) * costs.scene.points *
                            costs.scene.settings().substeps * 1e-6;
        fmt::format_to(out, "| {} | {} | {} | {} | {} |\n", costs.scene.strands,
                       nameOf(costs.scene.activeForces), costs.threads, spread(costs.step),
                       shortened(costs.step.median() * work));
    }
}

/// One table per scene on one thread: stages down, strands across.
void writeStages(const SimulationBench& bench, Out out) {
    for (const scenes::ActiveForces activeForces : scenes::kActiveForces) {
        std::vector<const StepCosts*> columns;
        for (const StepCosts& costs : bench.steps) {
            if (costs.scene.activeForces == activeForces && costs.threads == 1) columns.push_back(&costs);
        }
        if (columns.empty()) continue;
        fmt::format_to(
            out, "\n## Stages: {}, one thread\n\nNanoseconds per particle and substep.\n\n| family | stage |",
            nameOf(activeForces));
        std::string rule = "|---|---|";
        for (const StepCosts* costs : columns) {
            fmt::format_to(out, " {} strands |", costs->scene.strands);
            rule += "---|";
        }
        fmt::format_to(out, "\n{}\n", rule);
        for (std::size_t i = 0; i < runtime::kStageCount; ++i) {
            const auto id = static_cast<runtime::StageId>(i);
            std::string cells;
            bool any = false;
            for (const StepCosts* costs : columns) {
                const auto stage = std::ranges::find(costs->stages, id, &StepCosts::Stage::id);
                any = any || stage != costs->stages.end();
                cells += stage == costs->stages.end() ? " – |"
                                                      : fmt::format(" {} |", shortened(stage->cost.median()));
            }
            if (any)
                fmt::format_to(out, "| {} | {} |{}\n", runtime::stageFamily(id), runtime::stageName(id),
                               cells);
        }
    }
}

void writeInstructionSets(const SimulationBench& bench, Out out) {
    fmt::format_to(
        out, "\n## Instruction sets\n\nNanoseconds per particle and substep, one thread.\n\n| set | scene |");
    std::string rule = "|---|---|";
    for (const std::uint32_t strands : bench.strands) {
        fmt::format_to(out, " {} strands |", strands);
        rule += "---|";
    }
    fmt::format_to(out, "\n{}\n", rule);
    for (const InstructionSetCosts& set : bench.instructionSets) {
        fmt::format_to(out, "| {} | {} |", set.set, nameOf(set.activeForces));
        for (const Measurement& step : set.steps) fmt::format_to(out, " {} |", spread(step));
        fmt::format_to(out, "\n");
    }
}

void writeOthers(const SimulationBench& bench, Out out) {
    fmt::format_to(out, "\n## A whole frame\n\n| what | ms |\n|---|---|\n");
    for (const Wanted& other : bench.others) {
        if (other.cost.unit == "ms")
            fmt::format_to(out, "| {} | {} |\n", other.cost.name, spread(other.cost));
    }
}

}  // namespace

std::string markdownOf(const SimulationBench& bench, const std::string& command) {
    std::string text;
    const Out out(text);
    writeMachine(bench, command, out);
    writeWanted(bench, out);
    writeSamples(bench, out);
    writeSteps(bench, out);
    writeStages(bench, out);
    text += thesisTable(bench.thesis);
    writeInstructionSets(bench, out);
    writeOthers(bench, out);
    return text;
}

}  // namespace hairloom::benchmarks
