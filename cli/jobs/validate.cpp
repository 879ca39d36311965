// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/validate.h"

#include <memory>

#include "cli/documents.h"
#include "cli/job.h"

namespace hairloom::cli {
namespace {

Result<Report> validateFile(const std::string& path, const std::string& unit) {
    const auto opened = openAny(path, unit);
    if (!opened) return tl::unexpected(opened.error());
    return Report{{"file", path},
                  {"format", opened->format},
                  {"valid", !hasErrors(opened->findings)},
                  {"findings", toReport(opened->findings)}};
}

JobRun declare(CLI::App& job) {
    struct Options {
        std::string file, unit;
    };
    const auto options = std::make_shared<Options>();
    job.add_option("file", options->file, "Project, hair file or mesh")->required();
    addUnitOption(job, options->unit);
    return [options](const std::string&) { return validateFile(options->file, options->unit); };
}

}  // namespace

Job validateJob() {
    return {"validate", "List problems that other programs would have with a file", "hair.tfx --json",
            declare};
}

}  // namespace hairloom::cli
