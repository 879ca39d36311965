// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands as curves of an Alembic file, for programs that read the plain schema and for Unreal's groom
// importer.

#include "exporters/prepared_strands.h"

namespace hairloom {

/// Writes, reads back and compares. `unreal` adds the attributes of Unreal's groom schema 1.5.
Result<ExportReport> writeAlembic(const Groom& groom, const std::filesystem::path& path,
                                  const StrandExportOptions& options, bool unreal);

}  // namespace hairloom
