// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What writers of cards have in common.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/cards/texture_files.h"
#include "exporters/strands.h"

namespace hairloom {

/// A writer of cards: its note says what cards are, and then what `target` says.
HairWriter cardWriter(const char* name, const char* label, const char* carries, ExportTarget target,
                      const char* suffix, WriteCards write);

/// Whether a format of cards has levels of strands, too, where they are asked for.
bool holdsStrandLevels(const HairWriter& writer);

/// For formats that have no springs.
LeftBehind springsLeftBehind();
/// For formats that have no joints.
LeftBehind jointsLeftBehind();

using CardFiles = std::vector<std::pair<std::filesystem::path, std::vector<std::byte>>>;
/// Writes the file that was asked for, which comes first, and those beside it. The names of all but the
/// first. Errors: files that cannot be written; then none is.
Result<std::vector<std::string>> writeTogether(const CardFiles& files);

}  // namespace hairloom
