// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "importers/alembic_archive.h"
#include "importers/raw_strands.h"

namespace hairloom {

/// Whether an object of the archive states a version of Unreal's groom schema.
bool hasUnrealSchema(const AlembicArchive& archive);

/// Whether a property says something of the file and nothing of its hair: version and tool.
bool isOfUnrealFile(std::string_view name);

/// Unreal takes a unit for a centimetre: so is a file of its schema read unless another unit was asked for.
/// Says so.
void assumeUnrealUnit(const StrandImportOptions& options, RawStrands& strands);

}  // namespace hairloom
