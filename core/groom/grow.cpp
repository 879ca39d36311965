// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/groom/groom.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 1024;

Status checkRequest(const ScalpMesh* scalp, std::span<const SurfacePoint> roots, float length,
                    std::uint32_t points) {
    if (!scalp)
        return fail("there is no scalp to grow hair on",
                    "expected a head, which `create` and `import --mesh` set");
    if (!(length > 0) || !std::isfinite(length))
        return fail(fmt::format("length is {} m", length), "expected more than 0");
    if (points < 2) return fail(fmt::format("{} points per strand", points), "expected at least 2");
    if (roots.size() > std::numeric_limits<std::uint32_t>::max() / points) {
        return fail(
            fmt::format("{} strands of {} points", roots.size(), points),
            fmt::format("expected at most {} points in all", std::numeric_limits<std::uint32_t>::max()));
    }
    for (std::size_t r = 0; r < roots.size(); ++r) {
        if (roots[r].triangle < scalp->triangleCount()) continue;
        return fail(fmt::format("root {} lies on triangle {}", r, roots[r].triangle),
                    fmt::format("the scalp has {}", scalp->triangleCount()));
    }
    return {};
}

std::vector<Vec3f> straightPoints(const ScalpMesh& scalp, std::span<const SurfacePoint> roots, float length,
                                  std::uint32_t points) {
    std::vector<Vec3f> positions(roots.size() * points);
    parallelFor(roots.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Vec3f root = scalp.pointAt(roots[s].triangle, roots[s].barycentric);
            const Vec3f along = scalp.normalAt(roots[s].triangle, roots[s].barycentric) * length;
            for (std::uint32_t p = 0; p < points; ++p) {
                positions[s * points + p] =
                    root + along * (static_cast<float>(p) / static_cast<float>(points - 1));
            }
        }
    });
    return positions;
}

std::vector<float> taperedRadii(const HairMaterial& material, std::size_t strands, std::uint32_t points) {
    std::vector<float> radii(strands * points);
    for (std::size_t i = 0; i < radii.size(); ++i) {
        const float t = static_cast<float>(i % points) / static_cast<float>(points - 1);
        radii[i] = material.rootRadius * (1.0f + t * (material.tipScale - 1.0f));
    }
    return radii;
}

std::vector<Vec2f> rootUvs(const ScalpMesh& scalp, std::span<const SurfacePoint> roots) {
    std::vector<Vec2f> uvs(roots.size());
    for (std::size_t s = 0; s < roots.size(); ++s)
        uvs[s] = scalp.uvAt(roots[s].triangle, roots[s].barycentric);
    return uvs;
}

}  // namespace

Result<Groom> growStraight(std::shared_ptr<const ScalpMesh> scalp, FaceSet selection,
                           std::span<const SurfacePoint> roots, float length, std::uint32_t points) {
    if (auto status = checkRequest(scalp.get(), roots, length, points); !status) {
        return tl::unexpected(status.error());
    }
    std::vector<std::uint32_t> offsets(roots.size() + 1);
    for (std::size_t s = 0; s < offsets.size(); ++s) offsets[s] = static_cast<std::uint32_t>(s * points);
    Groom groom = makeGroom(std::move(offsets), straightPoints(*scalp, roots, length, points));
    groom.pointAttributes.set(attribute::kRadius, taperedRadii(groom.material, roots.size(), points));
    groom.setRootBindings(roots);
    groom.strandAttributes.set(attribute::kRootUv, rootUvs(*scalp, roots));
    std::vector<std::uint32_t> ids(roots.size());
    std::iota(ids.begin(), ids.end(), 0u);
    groom.strandAttributes.set(attribute::kStrandId, std::move(ids));
    auto triangulation = triangulateRoots(*scalp, selection, roots);
    if (!triangulation) return tl::unexpected(triangulation.error());
    groom.triangulation = std::move(*triangulation);
    groom.scalp = std::move(scalp);
    groom.scalpSelection = std::move(selection);
    return groom;
}

}  // namespace hairloom
