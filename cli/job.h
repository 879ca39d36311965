// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What every job of the command line shares: how it is declared, what it answers, how it ends. docs/cli.md is
// the contract. A job is one file of cli/jobs: nameJob() in name.cpp says what it is.

#include <CLI/App.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom::cli {

/// What a job did: printed as one JSON object, or as one line per key.
using Report = nlohmann::ordered_json;

/// Does the job with the options that were parsed. The text is the program's command line, for reports.
using JobRun = std::function<Result<Report>(const std::string& commandLine)>;

/// A subcommand of the program.
struct Job {
    std::string name;
    std::string does;                     ///< a line of the help
    std::string example;                  ///< its arguments in an example
    JobRun (*addOptions)(CLI::App& job);  ///< adds its options to `job`
};

/// All of them, in order of name.
const std::vector<Job>& jobs();

/// Adds the job's options to `app`, and --unit of hair files that state none where the job takes a groom and
/// has no --unit of its own. What is given back runs the job. Its errors name the file that the job works on
/// where they name none.
JobRun declareJob(const Job& job, CLI::App& app);

/// Declares every job to the program.
class Jobs {
  public:
    explicit Jobs(CLI::App& app);

    /// Runs the job that was asked for; one was, where parsing succeeded. Throws WrongUsage for a manifest of
    /// a job that was given nothing to write.
    Result<Report> run(const std::string& commandLine, bool withManifest) const;

  private:
    CLI::App* command_ = nullptr;
    JobRun chosen_;
};

}  // namespace hairloom::cli
