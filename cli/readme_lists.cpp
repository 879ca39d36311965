// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/readme_lists.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "cli/job.h"
#include "core/documents/hair_export.h"
#include "core/documents/sample.h"
#include "core/editing/brush_list.h"
#include "core/operations/operation.h"
#include "core/stability/stability.h"
#include "importers/child_process.h"
#include "importers/mesh_format.h"
#include "importers/strands.h"

namespace hairloom::cli {
namespace {

constexpr std::string_view kBegin =
    "<!-- lists: `hairloom-cli reference --readme README.md` makes them -->\n";
constexpr std::string_view kEnd = "<!-- end of lists -->\n";

using Names = std::vector<std::string>;

Names labels(const std::vector<FileFormat>& formats) {
    Names names;
    for (const FileFormat& format : formats) names.push_back(format.label);
    return names;
}

/// Labels of what is written, each once: some formats differ by the program that they are for.
Names writers(bool cards) {
    Names names;
    for (const HairWriter& writer : hairWriters()) {
        if (writer.holdsCards() == cards && std::ranges::find(names, writer.label) == names.end())
            names.push_back(writer.label);
    }
    return names;
}

/// Without what a target's name says of the format.
Names programs() {
    Names names;
    for (const HairWriter& writer : hairWriters()) {
        for (const ExportTarget& target : writer.targets) {
            std::string name = target.name.substr(0, target.name.find_first_of(",("));
            while (!name.empty() && name.back() == ' ') name.pop_back();
            if (target.program != "plain" && std::ranges::find(names, name) == names.end())
                names.push_back(name);
        }
    }
    std::ranges::sort(names);
    return names;
}

Names brushes() {
    Names names;
    for (const std::string_view name : editing::brushNames())
        names.emplace_back(editing::brushInfo(name).label);
    std::ranges::sort(names);
    return names;
}

Names operators() {
    Names names;
    for (const Operation& operation : operations()) {
        if (operation.stacks) names.emplace_back(operation.name);
    }
    return names;
}

std::string row(std::string_view what, const Names& names, bool counted = false) {
    const std::string count = counted ? fmt::format(" ({})", names.size()) : std::string();
    return fmt::format("| {}{} | {} |\n", what, count, fmt::join(names, ", "));
}

std::string table() {
    std::string text = "| | |\n|---|---|\n";
    text += row("Heads in", labels(meshFormats()));
    text += row("Hair in", labels(strandFormats()));
    text += row("Hair out", writers(false));
    text += row("Cards out", writers(true));
    text += row("Export targets", programs());
    text += row("Sample hairstyles", sampleNames(findSamples(programFolder())), true);
    text += row("Brushes", brushes(), true);
    text += row("Operators", operators(), true);
    text += fmt::format("| Hard cases | {}, each with every integrator ([stability](docs/stability.md)) |\n",
                        hardCases().size());
    text +=
        fmt::format("| Jobs of the command line | {} ([reference](docs/reference.md)) |\n", jobs().size());
    return text;
}

}  // namespace

Result<std::string> withLists(const std::string& readme) {
    const auto begin = readme.find(kBegin), end = readme.find(kEnd);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        return fail("the markers of its lists are missing",
                    fmt::format("expected {} and {}, each a line", kBegin.substr(0, kBegin.size() - 1),
                                kEnd.substr(0, kEnd.size() - 1)));
    return readme.substr(0, begin + kBegin.size()) + table() + readme.substr(end);
}

}  // namespace hairloom::cli
