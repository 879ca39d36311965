// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Layers as formats keep strands apart: prims of USD, objects of Alembic, groups of OBJ.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exporters/exported_attributes.h"
#include "exporters/prepared_strands.h"

namespace hairloom {

/// A layer's strands.
struct ExportedPart {
    std::string name;         ///< legal in the file, and of no other part
    std::string displayName;  ///< the layer's own name, where the part's is another; else empty
    bool areGuides = false;   ///< that other parts' hairs follow
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

/// Units of the file per second at one of at least two samples, by those before and after it: exact where
/// points move evenly accelerated.
std::vector<Vec3f> pointVelocities(std::span<const std::span<const Vec3f>> samples, std::size_t sample,
                                   const StrandFrames& frames);

/// One for each of the strands' parts; "hair" where there is one alone.
std::vector<ExportedPart> exportedParts(const Groom& groom, const PreparedStrands& strands,
                                        NameGiver::Legal isLegal);

}  // namespace hairloom
