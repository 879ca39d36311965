// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/stopwatch.h"
#include "core/base/file.h"
#include "core/groom/file/project_file.h"
#include "core/scene/hair_import.h"

namespace hairloom::cli {
namespace {

struct GroomOptions {
    std::string input;
    std::string script;
    std::string output;
};

Result<Report> replay(const GroomOptions& options) {
    const Stopwatch watch;
    auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto text = readTextFile(options.script);
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

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<GroomOptions>();
    job.add_option("groom", options->input, "Groom to work on")->required();
    job.add_option("--script", options->script, "Operations (docs/formats/script.md)")->required();
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) { return replay(*options); };
}

}  // namespace

Job groomJob() {
    return {"groom", "Replay a list of grooming operations on a groom",
            "hair.hairloom --script bob.json -o bob.hairloom", declare};
}

}  // namespace hairloom::cli
