// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "cli/documents.h"
#include "cli/field_rows.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/stopwatch.h"
#include "core/documents/hair_import.h"
#include "core/groom/file/project_file.h"

namespace hairloom::cli {
namespace {

struct GroomOptions {
    std::string input;
    std::string script;
    std::string output;
    bool list = false;
};

Result<Report> replay(const GroomOptions& options) {
    const Stopwatch watch;
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto text = readTextFile(options.script, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto script = parseDocumentScript(options.script, *text);
    if (!script) return tl::unexpected(script.error());
    const auto outcome = runScript(*script, *groom);
    if (!outcome) return tl::unexpected(outcome.error());
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    return Report{{"strokes", outcome->strokes},
                  {"touched_strands", outcome->touchedStrands},
                  {"seconds", watch.seconds()},
                  {"output", options.output}};
}

/// What scripts may say: operations, and the brushes of the operation "stroke".
Result<Report> list() {
    Report operators = Report::array();
    for (const Operation& operation : operations()) {
        Report formulas = Report::array();
        for (const char* field : operation.formulaFields) formulas.push_back(field);
        operators.push_back(Report{{"name", operation.name},
                                   {"meaning", operation.meaning},
                                   {"fields", reportOf(operation.fields())},
                                   {"formulas", std::move(formulas)}});
    }
    Report brushes = Report::array();
    for (const std::string_view name : editing::brushNames()) {
        const editing::BrushInfo& brush = editing::brushInfo(name);
        brushes.push_back(Report{{"name", brush.name},
                                 {"label", brush.label},
                                 {"meaning", brush.meaning},
                                 {"inverse", brush.inverse},
                                 {"fields", reportOf(parameterRows(brush))}});
    }
    return Report{{"operators", std::move(operators)},
                  {"region", reportOf(scriptRegionFields())},
                  {"mask", reportOf(scriptMaskFields())},
                  {"brushes", std::move(brushes)},
                  {"brush_settings", reportOf(fieldRows<editing::BrushSettings>())}};
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<GroomOptions>();
    auto* listing = job.add_flag("--list", options->list,
                                 "List all operations and brushes with their fields, units and ranges");
    auto* input = job.add_option("groom", options->input, "Groom to work on")->excludes(listing);
    auto* script =
        job.add_option("--script", options->script, "Script of operations (docs/formats/script.md)");
    auto* output = job.add_option("-o,--output", options->output, "Project to write");
    job.final_callback([listing, input, script, output] {
        if (listing->count() == 0 && input->count() * script->count() * output->count() == 0)
            throw CLI::RequiredError("groom, --script and -o");
    });
    return [options](const std::string&) {
        if (options->list) return list();
        return withOutputs({{options->output, content::kProject}}, [&] { return replay(*options); });
    };
}

}  // namespace

Job groomJob() {
    return {"groom", "Apply a script of grooming operations to a groom",
            "hair.hairloom --script bob.json -o bob.hairloom", declare};
}

}  // namespace hairloom::cli
