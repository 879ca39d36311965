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
/// Share of the roots that darts aim for: the others go where gaps are widest, so that the count is met.
constexpr double kThrown = 0.985;
constexpr int kMaxTries = 64;
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

Result<Placement> placeDarts(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request) {
    if (Status status = checkPlacement(mesh, faces, request.mask); !status)
        return tl::unexpected(status.error());
    const double area = maskedArea(mesh, faces, request.mask);
    const Result<std::size_t> count = requestedCount(request, area);
    if (!count) return tl::unexpected(count.error());
    const auto wanted = static_cast<double>(*count);
    const double finest = finestRadius(mesh);
    // Radii known to leave gaps for too few roots, and to take too many.
    double tooWide = std::numeric_limits<double>::infinity(), tooNarrow = 0;
    double radius = std::sqrt(kSaturated * area / (wanted * kThrown));
    for (int attempt = 0; attempt < kMaxTries; ++attempt) {
        if (radius < finest) return tooDense(wanted / area, finest);
        DartThrower thrower(mesh, faces, request.mask, static_cast<float>(radius), request.seed);
        const bool fewEnough = thrower.run(*count);
        const auto thrown = static_cast<double>(thrower.rootCount());
        if (fewEnough) {
            if (const auto apart = thrower.fillWidestGaps(*count))
                return Placement{thrower.takeRoots(), *apart};
        }
        (fewEnough ? tooWide : tooNarrow) = radius;
        if (tooNarrow > 0 && std::isfinite(tooWide))
            radius = (tooNarrow + tooWide) / 2;
        else
            radius *= fewEnough ? std::min(0.995, std::sqrt(thrown / (wanted * kThrown))) : 1.02;
    }
    return fail(fmt::format("no distance between roots gives {} of them on this selection", *count),
                "another count, or fewer separate pieces");
}

}  // namespace hairloom
