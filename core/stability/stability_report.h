// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hard cases and the maps as tables, drawings and a page.

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/stability/stability.h"
#include "core/stability/stability_map.h"

namespace hairloom {

/// "pass", "FAIL", or for what is not claimed "held", "limit, at substep 64" or "limit: " and
/// decidingThreshold().
std::string verdict(const StabilityResult& result);

/// "time to rest 6 of 5 s": the threshold that decides.
std::string decidingThreshold(const StabilityResult& result);

/// One line per threshold after a head line, RFC 4180: number, case, family, integrator, substeps, claimed,
/// pass, measured, worst, threshold, unit, failed_at, limit.
std::string stabilityCsv(const std::vector<StabilityResult>& results);

/// A table for docs/stability.md: a row per case, a column per integrator.
std::string stabilityMarkdown(const std::vector<StabilityResult>& results);

/// Writes cases.csv, cases.md, stability-INTEGRATOR-FORCE.svg of each map and report.html into the folder,
/// which is made where it is missing. Returns the names of the files in it. `commandLine` may be empty.
Result<std::vector<std::string>> writeStability(const std::vector<StabilityResult>& results,
                                                const std::vector<StabilityMap>& maps,
                                                const std::string& commandLine,
                                                const std::filesystem::path& folder);

}  // namespace hairloom
