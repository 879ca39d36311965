// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `info --diff`: what changed between two files.

#include <string>

#include "cli/job.h"

namespace hairloom::cli {

/// Two projects, two assets or two hair files of a format are compared in all that they hold, files of
/// different formats in their strands. `unit` is that of files which state none. Errors: as openAny().
Result<Report> compareFiles(const std::string& before, const std::string& after, const std::string& unit);

}  // namespace hairloom::cli
