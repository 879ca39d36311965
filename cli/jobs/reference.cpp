// SPDX-License-Identifier: GPL-3.0-or-later
// The page docs/reference.md, made from the descriptions that the program itself works by.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <memory>
#include <sstream>

#include "cli/field_rows.h"
#include "cli/global_options.h"
#include "cli/help_format.h"
#include "cli/job.h"
#include "cli/job_list.h"
#include "cli/man_pages.h"
#include "cli/outputs.h"
#include "cli/readme_lists.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/groom/file/fields.h"
#include "core/operations/script.h"

namespace hairloom::cli {
namespace {

std::string rangeOf(const FieldInfo& field) {
    switch (field.kind) {
        case FieldKind::Bool:
            return "true or false";
        case FieldKind::Choice:
            return fmt::format("{}", fmt::join(field.choices, ", "));
        case FieldKind::Seed:
            return "0 … 2^64 − 1";
        case FieldKind::Ramp:
            return "2 to 16 keys";
        case FieldKind::Float:
        case FieldKind::Int:
        case FieldKind::Vector:
        case FieldKind::Colour:
            break;
    }
    return fmt::format("{} … {}", field.min, field.max);
}

void addFields(const std::vector<FieldRow>& rows, std::string& page) {
    if (rows.empty()) return;
    page += "\n| field | default | unit | range | meaning |\n|---|---|---|---|---|\n";
    for (const auto& [info, defaultValue] : rows) {
        page += fmt::format("| `{}` | {} | {} | {} | {} |\n", info.name, defaultValue.dump(), info.unit,
                            rangeOf(info), info.meaning);
    }
}

std::string asSentence(std::string_view words) {
    std::string text(words);
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text + '.';
}

void addSettings(std::string& page) {
    page +=
        "\n## Settings of a groom\n\nA project file has an object for each section. Set a field with "
        "`hairloom-cli set GROOM SECTION.FIELD=VALUE`.\nThe exception is `placement`, which the editor and "
        "the script operation `placement` set.\n";
    std::vector<Section> sections = settingsSections();
    sections.push_back(
        {"placement", "how the editor places roots and grows strands", fieldRows<PlacementSettings>()});
    for (const Section& section : sections) {
        page += fmt::format("\n### `{}`\n\n{}\n", section.name, asSentence(section.holds));
        addFields(section.fields, page);
    }
}

void addOperations(std::string& page) {
    page +=
        "\n## Operations of scripts\n\n[formats/script.md](formats/script.md) describes them and shows how "
        "to write a script.\n\n### `region`\n\nEvery operation takes a region, which limits it to some "
        "strands.\n";
    addFields(scriptRegionFields(), page);
    page +=
        "\n### `mask`\n\nThe operations that a stack may hold take a mask, and so does the sculpt. It scales "
        "their effect.\n";
    addFields(scriptMaskFields(), page);
    for (const Operation& operation : operations()) {
        page += fmt::format("\n### `{}`\n\n{}\n", operation.name, asSentence(operation.meaning));
        addFields(operation.fields(), page);
        if (operation.formulaFields.empty()) continue;
        page += "\nFields that may be formulas:";
        for (const char* field : operation.formulaFields)
            page += fmt::format("{} `{}`", field == operation.formulaFields.front() ? "" : ",", field);
        page += ".\n";
    }
}

void addBrushes(std::string& page) {
    page += "\n## Brushes\n\nAll brushes have these settings and the curves `falloff` and `profile`.\n";
    addFields(fieldRows<editing::BrushSettings>(), page);
    for (const std::string_view name : editing::brushNames()) {
        const editing::BrushInfo& brush = editing::brushInfo(name);
        page += fmt::format("\n### `{}`: {}\n\n{}", name, brush.label, asSentence(brush.meaning));
        if (!brush.inverse.empty()) page += fmt::format(" Inverted: {}.", brush.inverse);
        page += '\n';
        addFields(parameterRows(brush), page);
    }
}

/// A cell of a table. Lines of a list, `abc  Alembic`, stay lines.
std::string cellOf(const std::string& text) {
    std::string cell;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto gap = line.find("  ");
        if (gap != std::string::npos)
            line = fmt::format("`{}` {}", line.substr(0, gap), line.substr(line.find_first_not_of(' ', gap)));
        cell += (cell.empty() ? "" : "<br>") + line;
    }
    for (auto at = cell.find('|'); at != std::string::npos; at = cell.find('|', at + 2))
        cell.insert(at, 1, '\\');
    return cell;
}

void addOptions(const CLI::App& app, std::string& page) {
    page += "\n| option | meaning |\n|---|---|\n";
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_name().empty() || option->get_name() == "--help" || option->get_description().empty())
            continue;
        page += fmt::format("| `{}` | {} |\n", cellOf(termOf(*option)), cellOf(meaningOf(*option)));
    }
}

void addJobs(std::string& page) {
    page +=
        "\n## Jobs of the command line\n\n`hairloom-cli JOB --help` shows the same options. "
        "[cli.md](cli.md) describes the answers. Every job\ntakes these options, before its name or after "
        "it.\n";
    CLI::App program;
    GlobalOptions global;
    addGlobalOptions(program, global);
    addOptions(program, page);
    for (const Job& job : jobs()) {
        page += fmt::format("\n### `{}`\n\n{}\n\n    hairloom-cli {} {}\n", job.name, asSentence(job.does),
                            job.name, job.example);
        CLI::App& app = *program.add_subcommand(job.name);
        declareJob(job, app);
        addOptions(app, page);
    }
}

Result<Report> write(const std::string& output) {
    std::string page =
        "# Reference\n\nEvery field with its unit, range and default, and every job of the command line. You "
        "need this page when you\nset a value or write a script. `hairloom-cli reference -o "
        "docs/reference.md` generates it from the program.\nDo not edit it.\n\nLengths are in metres, time "
        "in seconds, angles in degrees. The range of a vector or colour applies to each\ncomponent. A colour "
        "is linear RGB.\n";
    addSettings(page);
    addOperations(page);
    addBrushes(page);
    addJobs(page);
    if (auto status = writeFileAtomically(output, page); !status) return tl::unexpected(status.error());
    return Report{{"bytes", page.size()}, {"output", output}};
}

Result<Report> writeManPages(const std::string& folder) {
    auto names =
        writeFiles(folder, {{"hairloom.1", editorManPage()}, {"hairloom-cli.1", commandLineManPage()}});
    if (!names) return tl::unexpected(names.error());
    return Report{{"output", folder}, {"files", *names}};
}

Result<Report> writeJobs(const std::string& path) {
    const std::string text = describedJobs().dump(2) + '\n';
    if (auto status = writeFileAtomically(path, text); !status) return tl::unexpected(status.error());
    return Report{{"bytes", text.size()}, {"jobs", jobs().size()}, {"output", path}};
}

Result<Report> writeReadme(const std::string& path) {
    const auto before = readTextFile(path);
    if (!before) return tl::unexpected(before.error());
    const auto page = withLists(*before);
    if (!page) return tl::unexpected(inFile(page.error(), path));
    if (auto status = writeFileAtomically(path, *page); !status) return tl::unexpected(status.error());
    return Report{{"bytes", page->size()}, {"output", path}};
}

JobRun declare(CLI::App& job) {
    struct Options {
        std::string output, man, readme, list;
    };
    const auto options = std::make_shared<Options>();
    auto* page = job.add_option("-o,--output", options->output, "Markdown file to write");
    auto* man =
        job.add_option("--man", options->man, "Folder for the manual pages hairloom.1 and hairloom-cli.1");
    auto* readme =
        job.add_option("--readme", options->readme, "README.md whose table of features to update in place");
    auto* list =
        job.add_option("--jobs", options->list, "JSON file to write, with every job and its options as data");
    page->excludes(man)->excludes(readme)->excludes(list);
    man->excludes(readme)->excludes(list);
    readme->excludes(list);
    job.require_option(1);
    return [options](const std::string&) {
        if (!options->man.empty())
            return withOutputFolder(options->man, {"hairloom.1", "hairloom-cli.1"},
                                    [&] { return writeManPages(options->man); });
        if (!options->readme.empty())
            return withOutputs({{options->readme}}, [&] { return writeReadme(options->readme); });
        if (!options->list.empty())
            return withOutputs({{options->list, content::kJson}}, [&] { return writeJobs(options->list); });
        return withOutputs({{options->output}}, [&] { return write(options->output); });
    };
}

}  // namespace

Job referenceJob() {
    return {"reference", "Write the reference page, the manual pages, or the jobs as data",
            "-o docs/reference.md", declare};
}

}  // namespace hairloom::cli
