// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Two measurements of the same settings beside each other: what has become slower or less exact.

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// One setting, before and after; times in ms, errors in mm root mean square.
struct ComparedRun {
    std::string setting;  ///< "substeps 2, points 24"
    double msBefore = 0, msAfter = 0;
    double errorBefore = 0, errorAfter = 0;
    bool divergedBefore = false, divergedAfter = false;  ///< then there are no numbers
    bool slower = false;     ///< by more than a tenth, and by more than the spread of either
    bool lessExact = false;  ///< by more than a tenth and a micrometre, or it diverges now
};

struct ComparedReports {
    std::vector<ComparedRun> runs;     ///< of settings that both have, in the order of the first
    std::vector<std::string> missing;  ///< settings that only one of them has
};

/// Of two tables as workPrecisionCsv() writes them. Errors name the line: another head line, a number that is
/// none, nothing in common.
Result<ComparedReports> compareReports(std::string_view before, std::string_view after);

}  // namespace hairloom
