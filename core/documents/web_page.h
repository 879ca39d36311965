// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A folder that shows a hairstyle in a browser, moving, without anything else installed.

#include <filesystem>

#include "core/documents/hair_export.h"

namespace hairloom {

/// The name of that export among the formats of strands.
inline constexpr const char* kWebFormat = "web";

/// Writes index.html, player.js (the runtime as WebAssembly, and what draws it), hair.js (asset and head as
/// text: a page from a disk may read no other files) and hair.hairrt, the asset itself, into `folder`, which
/// is made where it is missing; files of these names are replaced. At rest; `wanted` has no frames. The
/// report is that of the asset. Errors: those of the asset; the player was not built; a file that cannot be
/// written.
Result<ExportReport> exportWebPage(const Groom& groom, const HairToExport& wanted,
                                   const std::filesystem::path& folder);

/// What the environment variable HAIRLOOM_WEB names, or else share/hairloom/web beside `programFolder` or a
/// folder above it; empty where there is no player.
std::filesystem::path findWebPlayer(const std::filesystem::path& programFolder);

}  // namespace hairloom
