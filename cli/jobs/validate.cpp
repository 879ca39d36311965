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

}  // namespace

void addValidateJob(Jobs& jobs) {
    struct Options {
        std::string file, unit;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& job = jobs.add("validate", "Say what a consumer of a file would trip over", "hair.tfx --json",
                             [options] { return validateFile(options->file, options->unit); });
    job.add_option("file", options->file, "Project, hair file or mesh")->required();
    addUnitOption(job, options->unit);
}

}  // namespace hairloom::cli
