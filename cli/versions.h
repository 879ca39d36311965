// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Versions in the names of a job's outputs (core/base/versioned_name.h).

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace hairloom::cli {

/// The options of a job that name what it writes, of those that there are.
std::vector<CLI::Option*> outputOptions(CLI::App& job);

/// Takes versions for the outputs of `job` when it is parsed: one for all of them.
void takeVersions(CLI::App& job);
/// Whether an output has got its version from takeVersions().
bool isVersioned(const std::string& output);
/// The outputs that got a version. What appears under these names from now on is not replaced.
std::vector<std::string> keepVersions();

}  // namespace hairloom::cli
