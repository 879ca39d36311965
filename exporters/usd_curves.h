// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What text and binary USD have in common: names, types and who reads them.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "exporters/exported_attributes.h"
#include "exporters/prepared_strands.h"

namespace hairloom {

/// "float3" of an attribute's elements.
std::string_view usdTypeOf(const ExportedAttribute& attribute);
/// USD's names have letters, digits, underscores and colons: others become underscores.
std::string usdName(const std::string& name);
std::vector<std::int32_t> curveVertexCounts(const PreparedStrands& strands);
/// The corners of the box around all points.
std::array<Vec3f, 2> extentOf(std::span<const Vec3f> positions);
std::vector<ExportTarget> usdTargets(const std::string& suffix);

}  // namespace hairloom
