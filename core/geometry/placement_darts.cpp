// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/dart_thrower.h"
#include "core/geometry/placement_area.h"

namespace hairloom {
namespace {

/// Roots of a saturated set in the plane per squared radius: disks of half the radius cover 0.5470 of it
/// (Zhang and Torquato 2013), and each covers π/4 squared radii.
constexpr double kSaturated = 0.5470 * 4 / 3.14159265358979323846;
constexpr double kSurplus = 1.008;  ///< aim for so many more than asked, so that the count is met at once
constexpr int kMaxTries = 48;
constexpr double kCm2PerM2 = 1e4;

/// Below this radius the rounding of coordinates blurs the distances.
double finestRadius(const ScalpMesh& mesh) {
    const Box3f box = mesh.bounds();
    const double farthest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
    return 256 * farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
}

tl::unexpected<Error> tooDense(double perM2, double finest) {
    return fail(
        fmt::format("{:.4g} roots per cm² are too close for the precision of the mesh", perM2 / kCm2PerM2),
        fmt::format("at most {:.4g} per cm²", kSaturated / (finest * finest) / kCm2PerM2));
}

}  // namespace

Result<Placement> placeDartsWithRadius(const ScalpMesh& mesh, const FaceSet& faces, float radius,
                                       std::span<const float> mask, std::uint64_t seed) {
    if (Status status = checkPlacement(mesh, faces, mask); !status) return tl::unexpected(status.error());
    if (!(radius > 0) || !std::isfinite(radius))
        return fail(fmt::format("a distance of {} metres between roots", radius), "a positive number");
    const double expected =
        kSaturated * maskedArea(mesh, faces, mask) / (static_cast<double>(radius) * radius);
    if (radius < finestRadius(mesh))
        return tooDense(kSaturated / (double{radius} * radius), finestRadius(mesh));
    PlacementRequest limits;
    limits.densityPerCm2 = expected / (maskedArea(mesh, faces, mask) * kCm2PerM2);
    if (expected >= 1)
        if (const auto count = requestedCount(limits, maskedArea(mesh, faces, mask)); !count)
            return tl::unexpected(count.error());
    DartThrower thrower(mesh, faces, mask, radius, seed);
    thrower.run(std::numeric_limits<std::size_t>::max());
    return Placement{thrower.takeRoots(), radius};
}

Result<Placement> placeDarts(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request) {
    if (Status status = checkPlacement(mesh, faces, request.mask); !status)
        return tl::unexpected(status.error());
    const double area = maskedArea(mesh, faces, request.mask);
    const Result<std::size_t> count = requestedCount(request, area);
    if (!count) return tl::unexpected(count.error());
    const auto wanted = static_cast<double>(*count);
    const double finest = finestRadius(mesh);
    // Radii known to give too few roots, and to leave gaps that are too wide.
    double tooWide = std::numeric_limits<double>::infinity(), tooNarrow = 0;
    double radius = std::sqrt(kSaturated * area / (wanted * kSurplus));
    for (int attempt = 0; attempt < kMaxTries; ++attempt) {
        if (radius < finest) return tooDense(wanted / area, finest);
        DartThrower thrower(mesh, faces, request.mask, static_cast<float>(radius), request.seed);
        const bool maximal = thrower.run(*count);
        const auto reached = static_cast<double>(thrower.rootCount());
        if (thrower.rootCount() == *count && (maximal || thrower.gapsWithin(2)))
            return Placement{thrower.takeRoots(), static_cast<float>(radius)};
        (maximal ? tooWide : tooNarrow) = radius;
        if (tooNarrow > 0 && std::isfinite(tooWide))
            radius = (tooNarrow + tooWide) / 2;
        else
            radius *= maximal ? std::min(0.999, std::sqrt(reached / (wanted * kSurplus))) : 1.05;
    }
    return fail(fmt::format("no distance between roots gives {} of them on this selection", *count),
                "another count, or fewer separate pieces");
}

}  // namespace hairloom
