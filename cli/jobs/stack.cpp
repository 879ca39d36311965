// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/stopwatch.h"
#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"

namespace hairloom::cli {
namespace {

struct StackOptions {
    std::string input;
    std::string from;
    std::string layer;  ///< name; empty: all
    std::string output;
    bool bake = false;
};

Result<std::vector<Operator>> readStack(const std::string& path) {
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto json = parseJson(path, *text);
    if (!json) return tl::unexpected(json.error());
    JsonReader reader(*json, path);
    auto operators = readOperators(reader);
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return operators;
}

Result<Report> edit(const StackOptions& options, Groom groom) {
    const Stopwatch watch;
    editing::Document document(std::move(groom));
    if (!options.from.empty()) {
        auto operators = readStack(options.from);
        if (!operators) return tl::unexpected(operators.error());
        auto command = editing::setOperators(document.model(), std::move(*operators), "Operators");
        if (!command) return tl::unexpected(inFile(command.error(), options.from));
        document.perform(std::move(*command));
    }
    if (options.bake) {
        auto command = editing::bakeOperators(document.model());
        if (!command) return tl::unexpected(command.error());
        document.perform(std::move(*command));
    }
    if (auto saved = saveProject(document.groom(), options.output); !saved)
        return tl::unexpected(saved.error());
    return Report{{"operators", toJson(document.groom().operators)},
                  {"seconds", watch.seconds()},
                  {"output", options.output}};
}

Result<Report> run(const StackOptions& options) {
    auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (!options.output.empty()) return edit(options, std::move(*groom));
    std::vector<Operator> shown = groom->operators;
    if (!options.layer.empty()) {
        const auto layer = std::ranges::find(groom->layers, options.layer, &Layer::name);
        if (layer == groom->layers.end())
            return failIn(options.input, {}, fmt::format("no layer is called '{}'", options.layer),
                          "the job `layers` lists them");
        const auto number = static_cast<std::uint32_t>(layer - groom->layers.begin()) + 1;
        std::erase_if(shown,
                      [&](const Operator& one) { return layerOf(one) != 0 && layerOf(one) != number; });
    }
    return Report{{"operators", toJson(shown)}};
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<StackOptions>();
    job.add_option("groom", options->input, "Groom whose operators are shown or set")->required();
    auto* output = job.add_option("-o,--output", options->output, "Project to write");
    auto* from =
        job.add_option("--from", options->from,
                       "Operators to have, as this job prints them with --json (docs/formats/script.md)");
    auto* bake =
        job.add_flag("--bake", options->bake, "Make the hair as it is all there is; no operators stay");
    job.add_option("--layer", options->layer, "Shows those alone that act on the layer of that name")
        ->excludes(output);
    from->needs(output);
    bake->needs(output);
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return run(*options); });
    };
}

}  // namespace

Job stackJob() {
    return {"stack", "Show, set or bake the operators of a groom", "hair.hairloom --json", declare};
}

}  // namespace hairloom::cli
