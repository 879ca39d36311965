// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Names of outputs with a version: `v###` in them becomes the next one that is free.

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace hairloom::cli {

/// The options of a job that name what it writes, of those that there are.
std::vector<CLI::Option*> outputOptions(CLI::App& job);

/// "v" and one to nine "#" at the beginning of a name in `path` or behind a character that is no letter or
/// digit.
bool hasVersionToken(const std::filesystem::path& path);
/// One more than the highest version of names in the folder that begin as this one does, whatever is behind;
/// 1 where there are none. `path` has a token.
unsigned nextVersion(const std::filesystem::path& path);
/// With the version in place of all tokens, in as many digits as they have "#", or more.
std::filesystem::path withVersion(const std::filesystem::path& path, unsigned version);

/// Takes versions for the outputs of `job` when it is parsed: one for all of them.
void takeVersions(CLI::App& job);
/// Whether an output has got its version from takeVersions().
bool isVersioned(const std::string& output);
/// The outputs that got a version. What appears under these names from now on is not replaced.
std::vector<std::string> keepVersions();

}  // namespace hairloom::cli
