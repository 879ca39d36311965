// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job.h"

#include <algorithm>
#include <string_view>

#include "cli/error_report.h"
#include "cli/finite_numbers.h"
#include "cli/outputs.h"
#include "cli/versions.h"

namespace hairloom::cli {
namespace {

/// Writes manifests of its parts whatever was asked for.
constexpr std::string_view kOwnManifest = "sweep";

}  // namespace

Jobs::Jobs(CLI::App& app) {
    for (const Job& job : jobs()) {
        CLI::App* const command = app.add_subcommand(job.name, job.does);
        command->footer("Example:\n  hairloom-cli " + job.name + " " + job.example);
        command->parse_complete_callback([this, command, run = job.declare(*command)] {
            command_ = command;
            chosen_ = run;
        });
        refuseNumbersThatAreNone(*command);
        takeVersions(*command);
    }
}

Result<Report> Jobs::run(const std::string& commandLine, bool withManifest) const {
    if (withManifest) {
        const auto isGiven = [](const CLI::Option* option) { return option->count() > 0; };
        if (std::ranges::none_of(outputOptions(*command_), isGiven))
            throw WrongUsage("--manifest lists outputs, and none is given", "expected it beside -o");
        if (command_->get_name() != kOwnManifest) writeManifest(commandLine);
    }
    const auto versioned = keepVersions();
    auto report = chosen_(commandLine);
    if (report && !versioned.empty()) (*report)["versioned"] = versioned;
    return report;
}

}  // namespace hairloom::cli
