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
/// silhouette_px, ms_draw, ms_move, and more; of one that was measured largest_patch_cm2, hairline_mm, rim,
/// scaliness, motion_px, holes (null where there is nothing to measure) and fails.
nlohmann::ordered_json toJson(const cards::Level& level);

/// "patch 3.65 cm² (at most 0.1)": the measures that a level fails; empty where it fails none.
std::string failureWords(const cards::Level& level);

/// motion, seconds, error_mm, largest_mm, the same two of springs that are not fitted, settling_mm, hz and
/// rates (hz, error_mm, largest_mm).
nlohmann::ordered_json toJson(const cards::SpringFit& fit);

/// The table and that of measures as text of Markdown; names of levels that fail are bold.
std::string levelTable(const cards::Chain& chain);

/// Strands above, the level below, from some directions.
render::Image sideBySide(const cards::Level& level);

/// The levels of cards and shells as they are seen from where they take over, in a row: strands left, the
/// level right of them, from two directions. Empty where there are none.
render::Image chainPicture(const cards::Chain& chain);

/// Writes all into a folder, which is made where it is missing; names in it, in order. Pictures of a level
/// are NAME.png, chain.png that of the chain; its textures NAME_colour.png (albedo and coverage),
/// NAME_shape.png (flow across and along, depth, ambient occlusion), NAME_normal.png and NAME_strand.png
/// (root to tip, strand's number), and mip maps of the first that keep coverage, NAME_colour.1.png and on;
/// NAME.json is a script that holds each of its cards as it is; levels.glb holds all of cards and shells.
Result<std::vector<std::string>> writeChain(const cards::Chain& chain, const std::string& commandLine,
                                            std::span<const cards::Collider> colliders,
                                            const cards::Character& character,
                                            const std::filesystem::path& folder);

}  // namespace hairloom
