// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Nearest surface point, signed distance and rays against a ScalpMesh.

#include <memory>
#include <optional>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// A bounding-volume tree over a mesh. Queries are const and may run on any number of threads at once.
class SurfaceTree {
  public:
    /// `faces` limits the tree to a selection; empty means the whole mesh. The mesh must outlive the tree.
    explicit SurfaceTree(const ScalpMesh& mesh, const FaceSet& faces = {});
    ~SurfaceTree();
    SurfaceTree(SurfaceTree&&) noexcept;
    SurfaceTree& operator=(SurfaceTree&&) noexcept;

    struct Hit {
        SurfacePoint surface;
        Vec3f position;  ///< metres
        float distance;  ///< metres, ≥ 0
    };
    /// The distance is infinite for a mesh without faces or a point that is not finite.
    Hit closest(const Vec3f& point) const;
    /// Distance with the sign of the angle-weighted pseudo-normal (Bærentzen and Aanæs 2005): negative
    /// inside, exact for a closed mesh; where the mesh is open it tells the side of the nearest face.
    float signedDistance(const Vec3f& point) const;
    /// First intersection with the ray; `direction` need not be of unit length.
    std::optional<Hit> firstHit(const Vec3f& origin, const Vec3f& direction) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom
