// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Options that several jobs have, and values that several reports hold.

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/job.h"
#include "core/documents/open.h"
#include "core/groom/validate.h"

namespace hairloom::cli {

/// Opened::format of what `export --format runtime` writes.
inline constexpr const char* kAssetFormat = "Hairloom runtime asset";

/// "m", "dm", …
std::vector<std::string> unitNames();
/// --unit m/dm/cm/mm/inch, or another name, for files that state none.
void addUnitOption(CLI::App& job, std::string& unit, const std::string& name = "--unit",
                   const std::string& of = "the file");
/// One number in [0, 1] per vertex of the mesh file, separated by white space; given back per vertex of the
/// mesh.
Result<std::vector<float>> readVertexMask(const std::string& path, const ScalpMesh& mesh);

Report toReport(const Finding& finding);
Report toReport(const std::vector<Finding>& findings);
/// Warns of all but information: not in the report alone, which few open while all seems well.
void tellFindings(const std::vector<Finding>& findings);
Report toReport(const Vec3f& vector);
/// JSON has no infinities.
Report finiteOrNull(double value);

}  // namespace hairloom::cli
