// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Everything that a project holds, as its file has it: saving writes it, and comparing walks it, so that what
// is saved is compared as well.

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/groom/file/archive.h"
#include "core/groom/groom.h"

namespace hairloom {

/// What the file says as JSON. The head's file is named as a project at `path` names it.
nlohmann::ordered_json projectHead(const Groom& groom, const std::filesystem::path& path);

/// Adds all arrays of the groom; they and `body` (bytes of the groom's skin collider, empty without one) must
/// live as long as the writer uses them.
void addProjectArrays(ArchiveWriter& writer, const Groom& groom, std::span<const std::uint8_t> body);

}  // namespace hairloom
