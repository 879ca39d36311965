// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/strand_finder.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 256;

/// Looks at points of the segment half a radius apart, so a touch of the rim may be missed.
bool segmentTouches(const BrushVolume& volume, const Vec3f& from, const Vec3f& to) {
    const float squaredRadius = volume.radius * volume.radius;
    const float pieces = std::ceil(2 * (to - from).norm() / volume.radius);
    constexpr float kMaxPieces = 64;
    const float count = std::clamp(pieces, 1.0f, kMaxPieces);
    for (int k = 0; k <= static_cast<int>(count); ++k) {
        const float t = static_cast<float>(k) / count;
        if (volume.squaredDistance(from + t * (to - from)) < squaredRadius) return true;
    }
    return false;
}

bool strandTouches(const BrushVolume& volume, std::span<const Vec3f> points) {
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (segmentTouches(volume, points[i - 1], points[i])) return true;
    }
    return false;
}

}  // namespace

std::vector<std::uint32_t> strandsWithin(const Groom& groom, const StrandBounds& bounds,
                                         const BrushVolume& volume, bool byRoots) {
    const std::vector<std::uint32_t> candidates = bounds.find(BoxTest(volume));
    std::vector<std::uint8_t> inside(candidates.size(), 0);
    parallelFor(candidates.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto points = groom.strand(candidates[k]);
            if (points.empty()) continue;
            const bool root = volume.squaredDistance(points[0]) < volume.radius * volume.radius;
            inside[k] = root || (!byRoots && strandTouches(volume, points)) ? 1 : 0;
        }
    });
    std::vector<std::uint32_t> found;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (inside[k]) found.push_back(candidates[k]);
    }
    return found;
}

}  // namespace hairloom::editing
