// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What strand writers have in common: choosing and resampling strands, converting units, and judging the
// result.

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/file.h"
#include "core/geometry/curve.h"
#include "exporters/strands.h"

namespace hairloom {

/// Strands of one layer, one after another.
struct PreparedPart {
    std::uint32_t layer = 0;  ///< of Groom::layers
    bool areGuides = false;   ///< that other strands of the groom follow
    std::size_t firstStrand = 0, strandCount = 0;
};

/// The strands that go into a file, in its units and axes.
struct PreparedStrands {
    std::vector<std::uint32_t> sources;      ///< strand of the groom
    std::vector<std::uint32_t> offsets{0};   ///< as in Groom
    std::vector<Vec3f> positions;            ///< units and axes of the file
    std::vector<std::vector<Vec3f>> frames;  ///< likewise, of strands that move
    std::vector<float> thickness;            ///< per point, diameter in units of the file
    std::vector<float> transparency;         ///< per point, or empty
    std::vector<Vec3f> colours;              ///< per point, or empty
    std::vector<PreparedPart> parts;         ///< that the strands are ordered by; at least one
    float metresPerUnit = 1;                 ///< of the file
    UpAxis up = UpAxis::Y;                   ///< likewise
    bool isResampled = false;                ///< some strand has other points than the groom's
    bool holdsPoses = false;                 ///< the file has the groom's poses, which nothing reads back
    std::vector<std::string> names;          ///< of attributes in the file, as exportedAttributes() gave them
    std::vector<Finding> findings;

    std::size_t strandCount() const { return sources.size(); }
};

enum class StrandOrder : std::uint8_t {
    groom,            ///< one part
    layers,           ///< for formats that keep layers apart
    layersAndGuides,  ///< those that keep guides apart, too, where the groom has guides and others
};

/// A point of the groom, in units and axes of the file.
Vec3f toFile(const Vec3f& position, const StrandExportOptions& options);

/// `pointsPerStrand` 0 keeps every strand's points; strands that have that many already keep theirs too.
/// Errors: options out of range, nothing to write.
Result<PreparedStrands> prepareStrands(const Groom& groom, const StrandExportOptions& options,
                                       std::uint32_t pointsPerStrand, StrandOrder order = StrandOrder::groom);

/// Values at even steps of the arc length, as resampleEvenly places the points.
template <class T>
std::vector<T> resampleValues(std::span<const Vec3f> points, std::span<const T> values, std::size_t count) {
    std::vector<T> result;
    result.reserve(count);
    for (const auto& [segment, t] : evenPlaces(points, count))
        result.push_back(values[segment] + (values[segment + 1] - values[segment]) * t);
    result.back() = values.back();
    return result;
}

/// Of Unity's hair (com.unity.demoteam.hair).
TargetLimits unityLimits();

/// Of the strands that are written: the groom's own, else those of their roots on the scalp; empty where
/// neither is known, as on a head without UVs, where strands have (0, 0) for want of any.
std::vector<Vec2f> rootUvs(const Groom& groom, const PreparedStrands& strands);

/// A file as its writer made it.
using FileContents = std::variant<std::vector<std::byte>, std::string>;

/// Writes the file, reads it back and measures how far it is from the groom. The contents are let go before
/// they are read back: beside a million strands they weigh.
Result<ExportReport> writeAndCompare(const Groom& groom, PreparedStrands prepared,
                                     const StrandExportOptions& options, const std::filesystem::path& path,
                                     FileContents contents);

}  // namespace hairloom
