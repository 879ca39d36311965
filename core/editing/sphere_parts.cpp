// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/sphere_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/editing/sphere_commands.h"
#include "core/geometry/selection.h"
#include "core/groom/spheres.h"

namespace hairloom::editing {
namespace {

constexpr std::string_view kPrefix = "group:";

/// How many spheres each part has: one, and then whichever has most area for each of its own the next.
std::vector<std::uint32_t> shares(const ScalpMesh& mesh, std::span<const SpherePart> parts,
                                  std::uint32_t count) {
    std::vector<std::uint32_t> of(parts.size(), 1);
    std::vector<double> areas;
    for (const SpherePart& part : parts) areas.push_back(selectionArea(mesh, part.faces));
    for (std::size_t given = parts.size(); given < count; ++given) {
        std::size_t next = parts.size();
        double most = 0;
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const double areaForEach = areas[p] / of[p];
            if (of[p] >= kMaxSpheres || areaForEach <= most) continue;
            most = areaForEach;
            next = p;
        }
        if (next == parts.size()) break;
        ++of[next];
    }
    return of;
}

Box3f boundsOf(const ScalpMesh& mesh, const FaceSet& faces) {
    Box3f box;
    for (const std::uint32_t face : faces) {
        for (const std::uint32_t v : mesh.triangles()[face]) box.extend(mesh.positions()[v]);
    }
    return box;
}

Result<std::vector<CollisionSphere>> fitPart(const ScalpMesh& mesh, const SpherePart& part,
                                             std::uint32_t count) {
    constexpr double kTooSmallToSample = 2e-6;  // m²
    const Box3f box = boundsOf(mesh, part.faces);
    SphereFitOptions options;
    // A ball behind an open sheet touches nothing on its other side: without bounds it would be far larger
    // than the sheet.
    options.largestRadius = std::clamp(box.diagonal().norm() / 2, kSmallestSphere, largestSphereIn(box));
    if (selectionArea(mesh, part.faces) < kTooSmallToSample) {
        return std::vector<CollisionSphere>{{{}, box.center(), options.largestRadius, {}, -1}};
    }
    options.count = count;
    options.region = part.faces;
    auto fit = fitSpheres(mesh, options);
    if (!fit)
        return fail(fmt::format("group '{}': {}", part.name, fit.error().problem), fit.error().expected);
    return std::move(fit->spheres);
}

}  // namespace

Result<SphereFit> fitSpheresToParts(const ScalpMesh& mesh, std::span<const SpherePart> parts,
                                    std::uint32_t count, const std::atomic<bool>* cancelled) {
    if (count < 1 || count > kMaxPartSpheres)
        return fail(fmt::format("{} spheres", count), fmt::format("1 to {}", kMaxPartSpheres));
    const std::vector<std::uint32_t> of = shares(mesh, parts, count);
    std::vector<CollisionSphere> spheres;
    FaceSet faces;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (cancelled && *cancelled)
            return fail("fitting spheres was cancelled", "expected it to run to its end");
        auto fitted = fitPart(mesh, parts[p], of[p]);
        if (!fitted) return tl::unexpected(fitted.error());
        for (std::size_t s = 0; s < fitted->size(); ++s) {
            (*fitted)[s].name = fmt::format("{}{} {}", kPrefix, parts[p].name, s + 1);
            spheres.push_back(std::move((*fitted)[s]));
        }
        faces.insert(faces.end(), parts[p].faces.begin(), parts[p].faces.end());
    }
    if (parts.empty()) return SphereFit{};
    std::ranges::sort(faces);
    return measureSpheres(mesh, faces, std::move(spheres));
}

std::vector<CollisionSphere> spheresOfParts(std::span<const CollisionSphere> spheres) {
    return keptSpheres(spheres, [&](std::size_t s) { return spheres[s].name.starts_with(kPrefix); });
}

}  // namespace hairloom::editing
