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

namespace hairloom {

/// The corners of the box around all points.
std::array<Vec3f, 2> extentOf(std::span<const Vec3f> positions);

/// "float3" of an attribute's elements.
std::string_view usdTypeOf(const ExportedAttribute& attribute);
std::vector<ExportTarget> usdTargets(const std::string& suffix);

}  // namespace hairloom
