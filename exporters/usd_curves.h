// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What text and binary USD have in common: prims, names, types and who reads them.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exporters/exported_attributes.h"
#include "exporters/exported_parts.h"
#include "exporters/usd_physics.h"

namespace hairloom {

/// The corners of the box around all points.
std::array<Vec3f, 2> extentOf(std::span<const Vec3f> positions);

/// What the prims of parts have beside their curves, and what stands beside these.
struct UsdMore {
    std::vector<UsdNode> ofParts;
    std::vector<UsdNode> beside;  ///< below /groom
};
UsdMore usdMore(const Groom& groom, const PreparedStrands& strands, const StrandExportOptions& options,
                std::span<const ExportedPart> parts, const std::string& physics);

/// "float3" of an attribute's elements.
std::string_view usdTypeOf(const ExportedAttribute& attribute);
std::vector<ExportTarget> usdTargets(const std::string& suffix);

}  // namespace hairloom
