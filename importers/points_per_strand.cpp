// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/points_per_strand.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace hairloom {
namespace {

constexpr std::size_t kFewestPoints = 3;
constexpr std::size_t kMostPoints = 65536;
constexpr float kClear = 2;  ///< a step between strands is this many times as long as one within them

/// Whether strands of `size` points are apart from each other as strands are.
bool isApart(std::span<const Vec3f> points, std::size_t size) {
    const std::size_t strands = points.size() / size;
    // Reconstructed hair has a few strands that jump, and tips that lie beside the next root. Half and twice
    // the number of points fail at every second strand.
    const std::size_t allowed = (strands - 1) / 8;
    std::size_t touching = 0;
    float longestBefore = 0;
    for (std::size_t strand = 0; strand < strands; ++strand) {
        const Vec3f* const first = &points[strand * size];
        float longest = 0;
        for (std::size_t i = 1; i < size; ++i)
            longest = std::max(longest, (first[i] - first[i - 1]).squaredNorm());
        if (strand > 0) {
            const float gap = (first[0] - first[-1]).squaredNorm();
            const bool isGap = gap > kClear * kClear * std::max(longest, longestBefore);
            if (!isGap && ++touching > allowed) return false;
        }
        longestBefore = longest;
    }
    return true;
}

}  // namespace

std::uint32_t guessPointsPerStrand(std::span<const Vec3f> points) {
    std::size_t found = 0;
    for (std::size_t size = kFewestPoints; size <= std::min(kMostPoints, points.size() / 2); ++size) {
        if (points.size() % size != 0 || !isApart(points, size)) continue;
        if (found != 0) return 0;
        found = size;
    }
    return static_cast<std::uint32_t>(found);
}

Result<StrandRuns> cutIntoStrands(const std::string& file, std::span<const Vec3f> points,
                                  std::uint32_t asked) {
    if (points.size() > std::numeric_limits<std::uint32_t>::max())
        return failIn(file, {}, fmt::format("has {} points", points.size()),
                      "expected at most 4,294,967,295");
    StrandRuns runs;
    std::size_t size = asked;
    if (asked == 0) size = runs.guessed = guessPointsPerStrand(points);
    if (size == 0)
        return failIn(file, {}, fmt::format("holds {} points without strands", points.size()),
                      "expected the number of points of a strand to be given (--points-per-strand), which "
                      "the distances between the points do not tell");
    if (points.empty() || points.size() % size != 0)
        return failIn(file, {}, fmt::format("has {} points, no multiple of {}", points.size(), size),
                      fmt::format("{} are left over", points.size() % size));
    for (std::size_t end = size; end <= points.size(); end += size)
        runs.offsets.push_back(static_cast<std::uint32_t>(end));
    return runs;
}

void noteRuns(StrandRuns& runs, RawStrands& raw) {
    raw.offsets = std::move(runs.offsets);
    raw.rootFirst = false;
    if (runs.guessed == 0) return;
    raw.warnings.push_back(fileNote(
        fmt::format("strands of {} points each were found by the distances between points", runs.guessed),
        "points", "--points-per-strand says another number"));
}

}  // namespace hairloom
