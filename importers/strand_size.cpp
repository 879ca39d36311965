// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/strand_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/curve.h"
#include "importers/length_unit.h"

namespace hairloom {
namespace {

// Metres. From eyebrows and stubble to hair that reaches the floor; from a doll's head to a horse's back.
constexpr float kShortest = 0.002f;
constexpr float kLongest = 2.0f;
constexpr float kSmallestSpread = 0.02f;
constexpr float kLargestSpread = 2.5f;
constexpr float kHead = 0.2f;  ///< spread of the roots on a human head
constexpr float kUsualLength = 0.2f;
constexpr std::size_t kEnoughRoots = 50;  ///< fewer say nothing about the size of a head

struct Size {
    float length;  ///< median of the strands
    float spread;  ///< largest side of the roots' bounds; 0 where there are too few roots
};

Size measure(std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions) {
    const std::size_t strands = offsets.size() - 1;
    const std::size_t step = std::max<std::size_t>(1, strands / 1000);
    std::vector<float> lengths;
    Box3f roots;
    for (std::size_t strand = 0; strand < strands; ++strand) {
        roots.extend(positions[offsets[strand]]);
        if (strand % step != 0) continue;
        lengths.push_back(
            polylineLength(positions.subspan(offsets[strand], offsets[strand + 1] - offsets[strand])));
    }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return {*middle, strands < kEnoughRoots ? 0.0f : roots.sizes().maxCoeff()};
}

bool isPlausible(const Size& size, float scale) {
    const float length = size.length * scale;
    const float spread = size.spread * scale;
    if (length < kShortest || length > kLongest) return false;
    return size.spread == 0 || (spread >= kSmallestSpread && spread <= kLargestSpread);
}

/// How far the size is from a usual head of hair; 0 is that size.
float unlikelihood(const Size& size, float scale) {
    const float usual = size.spread > 0 ? kHead : kUsualLength;
    const float found = size.spread > 0 ? size.spread : size.length;
    return std::abs(std::log(found * scale / usual));
}

/// Of those in which the size is plausible the one nearest to a usual head; null where there is none.
const LengthUnit* fittingUnit(const Size& size, float metresPerUnit) {
    const LengthUnit* best = nullptr;
    float bestScale = 0;
    for (const LengthUnit& unit : lengthUnits()) {
        const float scale = static_cast<float>(unit.metres) / metresPerUnit;
        if (!isPlausible(size, scale)) continue;
        if (best && unlikelihood(size, scale) >= unlikelihood(size, bestScale)) continue;
        best = &unit;
        bestScale = scale;
    }
    return best;
}

}  // namespace

Error tooFar(const FarPoint& far, std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions,
             float metresPerUnit) {
    Error error;
    error.problem =
        fmt::format("strand {} has its point {} {:.4g} m from the origin", far.strand, far.point, far.metres);
    error.expected = fmt::format("expected all points within {} m", kFarthestPoint);
    const Size size = measure(offsets, positions);
    const LengthUnit* const unit = isPlausible(size, 1.0f) ? nullptr : fittingUnit(size, metresPerUnit);
    error.expected += unit != nullptr ? fmt::format("; the unit {} would fit the strands", unit->name)
                                      : "; fix the strand, scale the file or move it to the origin";
    return error;
}

std::optional<Finding> implausibleSize(std::span<const std::uint32_t> offsets,
                                       std::span<const Vec3f> positions, float metresPerUnit) {
    const Size size = measure(offsets, positions);
    if (isPlausible(size, 1.0f)) return std::nullopt;
    const LengthUnit* const best = fittingUnit(size, metresPerUnit);
    Finding finding{
        Severity::Warning, fmt::format("strands are {:.4g} m long (median)", size.length), "size", {}};
    if (size.spread > 0) finding.what += fmt::format(" and their roots spread over {:.4g} m", size.spread);
    finding.what += ", which is unlikely for hair";
    finding.fix = best ? fmt::format("the unit {} would fit: strands of {:.4g} m", best->name,
                                     size.length * static_cast<float>(best->metres) / metresPerUnit)
                       : "none of the units m, dm, cm, mm and inch fits, so scale the file";
    return finding;
}

}  // namespace hairloom
