// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a runtime asset has beside its hair: attributes of strands by name, and how far levels of detail are
// off.

#include <cstddef>
#include <span>
#include <vector>

#include "exporters/asset_builder.h"
#include "exporters/prepared_strands.h"

namespace hairloom {

/// All attributes of the strands but those that are a tool's state or have sections of their own; "root_uv"
/// of a head with a texture's coordinates, too.
void addAttributes(const Groom& groom, const PreparedStrands& strands, AssetBuilder& builder);

/// Errors of all levels: of the paths of points, and of what is seen far off (hl_level).
struct MeasuredLevels {
    std::vector<asset::MeasuredLevel> paths, seen;
};
/// By playing the asset. Empty where it cannot be played, or would take minutes.
MeasuredLevels measureLevels(std::span<const std::byte> file);

}  // namespace hairloom
