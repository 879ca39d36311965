// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A folder that shows a hairstyle in a browser, moving, without anything else installed.

#include <filesystem>

#include "core/documents/hair_export.h"
#include "core/render/colour_transform.h"

namespace hairloom {

/// The name of that export among the formats of strands.
inline constexpr const char* kWebFormat = "web";

/// Writes index.html, player.js (the runtime as WebAssembly, and what draws it), hair.js (asset and head as
/// text: a page from a disk may read no other files) and hair.hairrt, the asset itself, into `folder`, which
/// is made where it is missing; files of these names are replaced. At rest; `wanted` has no frames. The page
/// shows hair and head through `toDisplay`, a view for sRGB, as a table of at most 129³ colours, 17 MB of
/// text; null: by its own tone curve. The report is that of the asset, with a warning where the table is off
/// by more than one of 255 code values. Errors: those of the asset; the player was not built; a file that
/// cannot be written.
Result<ExportReport> exportWebPage(const Groom& groom, const HairToExport& wanted,
                                   const std::filesystem::path& folder,
                                   const render::ColourTransform* toDisplay = nullptr);

/// What the environment variable HAIRLOOM_WEB names, or else share/hairloom/web beside `programFolder` or a
/// folder above it; empty where there is no player.
std::filesystem::path findWebPlayer(const std::filesystem::path& programFolder);

}  // namespace hairloom
