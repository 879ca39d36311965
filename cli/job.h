// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What every job of the command line shares: how it is declared, what it answers, how it ends. docs/cli.md is
// the contract.

#include <CLI/App.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/result.h"

namespace hairloom::cli {

/// What a job did: printed as one JSON object, or as one line per key.
using Report = nlohmann::ordered_json;

/// The subcommands of the program and the one that was asked for.
class Jobs {
  public:
    explicit Jobs(CLI::App& app) : app_(app) {}

    /// Declares a job. `run` is called after parsing when it is the one asked for.
    CLI::App& add(const std::string& name, const std::string& does, const std::string& example,
                  std::function<Result<Report>()> run);

    /// What the program was called with, for reports; as main() was given it, separated by spaces.
    void setCommandLine(std::string text) { commandLine_ = std::move(text); }
    const std::string& commandLine() const { return commandLine_; }

    /// Runs the job that was asked for.
    Result<Report> run() const;

  private:
    CLI::App& app_;
    std::function<Result<Report>()> chosen_;
    std::string commandLine_;
};

void addCreateJob(Jobs& jobs);
void addInfoJob(Jobs& jobs);
void addImportJob(Jobs& jobs);
void addExportJob(Jobs& jobs);
void addValidateJob(Jobs& jobs);
void addGroomJob(Jobs& jobs);
void addSpheresJob(Jobs& jobs);
void addSetJob(Jobs& jobs);
void addSimulateJob(Jobs& jobs);
void addRenderJob(Jobs& jobs);
void addDevicesJob(Jobs& jobs);
void addBenchJob(Jobs& jobs);
void addAccuracyJob(Jobs& jobs);
void addEffectsJob(Jobs& jobs);
void addBudgetJob(Jobs& jobs);
void addStabilityJob(Jobs& jobs);

}  // namespace hairloom::cli
