// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What text and binary USD have in common: prims, names, types and who reads them.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "exporters/exported_attributes.h"
#include "exporters/prepared_strands.h"

namespace hairloom {

/// A prim of curves: a layer's strands.
struct UsdPart {
    std::string name;         ///< legal and of no other prim
    std::string displayName;  ///< the layer's own name, where the prim's is another; else empty
    std::size_t firstStrand = 0, strandCount = 0, firstPoint = 0, pointCount = 0;

    std::span<const Vec3f> points(std::span<const Vec3f> all) const {
        return all.subspan(firstPoint, pointCount);
    }
    std::span<const float> widths(const PreparedStrands& strands) const {
        return std::span(strands.thickness).subspan(firstPoint, pointCount);
    }
    std::vector<std::int32_t> vertexCounts(const PreparedStrands& strands) const;
    /// The corners of the box around all points with half the greatest width.
    std::array<Vec3f, 2> extent(const PreparedStrands& strands, std::span<const Vec3f> all) const;
    std::span<const float> numbers(const ExportedAttribute& attribute) const;
    std::span<const std::int32_t> wholes(const ExportedAttribute& attribute) const;
};

/// One for each layer that has strands; "hair" where there is one alone.
std::vector<UsdPart> usdParts(const Groom& groom, const PreparedStrands& strands);

/// The corners of the box around all points.
std::array<Vec3f, 2> extentOf(std::span<const Vec3f> positions);

/// "float3" of an attribute's elements.
std::string_view usdTypeOf(const ExportedAttribute& attribute);
std::vector<ExportTarget> usdTargets(const std::string& suffix);

}  // namespace hairloom
