// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A certificate and its parts as JSON.

#include <string>

#include "cli/job.h"
#include "core/stability/certificate.h"

namespace hairloom::cli {

/// With the first failures, and what it says in words.
Report toReport(const Certificate& certificate);

/// With all failures: tallies are joined from what this writes.
Report toReport(const StormTally& tally);
/// What toReport() wrote. Errors: members that are missing or of another type, named as of `file`.
Result<StormTally> tallyFrom(const Report& report, const std::string& file);

}  // namespace hairloom::cli
