// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What all parts of a sweep say together.

#include "cli/sweep_parts.h"

namespace hairloom::cli {

/// How the parts stand.
struct SweepOutcome {
    std::size_t parts = 0, done = 0, failed = 0;
    std::vector<std::string> failures;  ///< "part 0007 (…): why"
    double seconds = 0;                 ///< of those done, summed
};

/// From the files alone; nothing is written.
SweepOutcome statusOf(const SweepFolder& folder);

/// Writes report.html, and, when all parts are done, merged.json (values and reports in order, without times:
/// the same bits wherever parts ran), table.csv (numbers of the reports), certificates.json (for storms),
/// manifest.json and manifest.xxh3 (every output of a part), and the folder files, where the sweep gathers.
/// Those of an earlier merge go. Errors: names that two parts gather, storms that are missing, a folder that
/// takes no files.
Result<SweepOutcome> mergeSweep(const SweepFolder& folder);

}  // namespace hairloom::cli
