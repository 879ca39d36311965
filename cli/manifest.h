// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What was written, from what, and how: for pipelines that check and publish files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/job.h"

namespace hairloom::cli {

/// The members that each manifest begins with.
Report manifestHead();
/// A file in a manifest; `hash` as hashText().
Report manifestRow(const std::string& name, std::uint64_t bytes, const std::string& hash);
/// XXH3 of a file's bytes in 16 digits; empty where it cannot be read.
std::string hashText(const std::filesystem::path& path);

/// The manifest of a job in the folder of `manifest`, which its names start at: `outputs` (which may wait for
/// their batch), the files that the job has read, and of projects among these what they hold. Errors: a file
/// that cannot be read.
Result<Report> manifestOf(const std::filesystem::path& manifest,
                          const std::vector<std::filesystem::path>& outputs, const std::string& commandLine);

}  // namespace hairloom::cli
