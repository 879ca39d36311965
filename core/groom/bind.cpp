// SPDX-License-Identifier: GPL-3.0-or-later
#include <cassert>
#include <numeric>

#include "core/base/parallel.h"
#include "core/geometry/closest_point.h"
#include "core/groom/groom.h"

namespace hairloom {

std::vector<float> bindToScalp(Groom& groom, std::shared_ptr<const ScalpMesh> scalp, FaceSet selection) {
    assert(scalp && scalp->triangleCount() > 0);
    constexpr std::size_t kRootsAtATime = 256;
    if (selection.empty()) {
        selection.resize(scalp->triangleCount());
        std::iota(selection.begin(), selection.end(), 0u);
    }
    const SurfaceTree tree(*scalp, selection);
    std::vector<SurfacePoint> roots(groom.strandCount());
    std::vector<Vec2f> uvs(groom.strandCount());
    std::vector<float> distances(groom.strandCount());
    parallelFor(groom.strandCount(), kRootsAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const SurfaceTree::Hit hit = tree.closest(groom.strand(s)[0]);
            roots[s] = hit.surface;
            uvs[s] = scalp->uvAt(hit.surface.triangle, hit.surface.barycentric);
            distances[s] = hit.distance;
        }
    });
    groom.setRootBindings(roots);
    groom.strandAttributes.set(attribute::kRootUv, std::move(uvs));
    groom.triangulation = {};
    if (groom.scalp != scalp) {
        groom.scalpDensity.clear();
        groom.body.reset();
    }
    groom.scalp = std::move(scalp);
    groom.scalpSelection = std::move(selection);
    return distances;
}

}  // namespace hairloom
