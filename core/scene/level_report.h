// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A chain of levels of detail as files: textures, meshes, pictures beside the strands, table and plot.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/cards/glb.h"
#include "core/cards/levels.h"

namespace hairloom {

/// A row of the table: name, kind, hairs, cards, triangles, bytes, distance_m, coverage, flip, light,
/// silhouette_px, ms_draw, ms_move, and more.
nlohmann::ordered_json toJson(const cards::Level& level);

/// The table as text of Markdown.
std::string levelTable(const cards::Chain& chain);

/// Strands above, the level below, from some directions.
render::Image sideBySide(const cards::Level& level);

/// Writes all into a folder, which is made where it is missing; names in it, in order. Pictures of a level
/// are NAME.png; its textures NAME_colour.png (albedo and coverage), NAME_shape.png (flow across and along,
/// depth, ambient occlusion), NAME_normal.png and NAME_strand.png (root to tip, strand's number), and mip
/// maps of the first that keep coverage, NAME_colour.1.png and on; levels.glb holds all of cards and shells.
Result<std::vector<std::string>> writeChain(const cards::Chain& chain, const std::string& commandLine,
                                            std::span<const cards::Collider> colliders,
                                            const std::filesystem::path& folder);

}  // namespace hairloom
