// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/finite_numbers.h"
#include "cli/outputs.h"
#include "cli/versions.h"

namespace hairloom::cli {
namespace {

/// Of errors that no input should meet, and that therefore name nothing that would have been right.
constexpr const char* kUnforeseen = "please report it with the command and its input";
/// Writes manifests of its parts whatever was asked for.
constexpr std::string_view kOwnManifest = "sweep";

/// What the job reads first, else what it writes; empty where it has neither.
std::string worksOn(const CLI::App& app) {
    for (const char* name : {"groom", "file", "--mesh", "--output"}) {
        const CLI::Option* const option = app.get_option_no_throw(name);
        if (option != nullptr && option->count() > 0) return option->results().front();
    }
    return {};
}

}  // namespace

JobRun declareJob(const Job& job, CLI::App& app) {
    const JobRun run = job.addOptions(app);
    const auto unit = std::make_shared<std::string>();
    if (app.get_option_no_throw("groom") != nullptr && app.get_option_no_throw("--unit") == nullptr)
        addUnitOption(app, *unit, "--unit", "hair files");
    return [&app, run, unit](const std::string& commandLine) -> Result<Report> {
        setUnitOfHairFiles(*unit);
        auto report = run(commandLine);
        if (!report) return tl::unexpected(expecting(inFile(report.error(), worksOn(app)), kUnforeseen));
        return report;
    };
}

Jobs::Jobs(CLI::App& app) {
    for (const Job& job : jobs()) {
        CLI::App* const command = app.add_subcommand(job.name, job.does);
        command->footer("Example:\n  hairloom-cli " + job.name + " " + job.example);
        command->parse_complete_callback([this, command, run = declareJob(job, *command)] {
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
