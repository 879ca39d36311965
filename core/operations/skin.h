// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The scalp as operations and brushes meet it: how far away, and which way is out.

#include <cmath>
#include <memory>
#include <optional>

#include "core/geometry/closest_point.h"

namespace hairloom {

struct SkinDistance {
    float distance;  ///< metres, negative inside
    Vec3f outward;   ///< unit length; distance grows along it
};

/// What keeps hair outside asks the skin. Queries may run on any number of threads at once.
class SkinQuery {
  public:
    virtual ~SkinQuery() = default;
    virtual SkinDistance distanceAt(const Vec3f& point) const = 0;
    /// The same where the distance is at most `enough` (metres). Where it is more, perhaps a smaller distance
    /// that is so too, and the direction says nothing.
    virtual SkinDistance distanceUpTo(const Vec3f& point, float /*enough*/) const {
        return distanceAt(point);
    }
};

/// The skin itself, exactly. The whole mesh counts, not just the selection.
class Skin final : public SkinQuery {
  public:
    explicit Skin(std::shared_ptr<const ScalpMesh> scalp) : scalp_(std::move(scalp)), tree_(*scalp_) {}

    struct Sample : SkinDistance {
        SurfacePoint surface;
    };
    Sample at(const Vec3f& point) const {
        const SurfaceTree::Hit hit = tree_.closest(point);
        const Vec3f normal = scalp_->normalAt(hit.surface.triangle, hit.surface.barycentric);
        const Vec3f away = point - hit.position;
        const float lean = away.dot(normal);
        // Near an edge the interpolated normal may point across `away`; the tree then looks at the faces
        // around.
        constexpr float kUnclear = 0.5f;
        const bool unclear = std::abs(lean) < kUnclear * hit.distance;
        const float side = (unclear ? tree_.signedDistance(point) : lean) < 0 ? -1.0f : 1.0f;
        // Within a hundredth of a millimetre the difference is mostly rounding.
        constexpr float kTouching = 1e-5f;
        const Vec3f outward = hit.distance > kTouching ? Vec3f(away * (side / hit.distance)) : normal;
        return {{side * hit.distance, outward}, hit.surface};
    }
    SkinDistance distanceAt(const Vec3f& point) const override { return at(point); }
    const ScalpMesh& mesh() const { return *scalp_; }
    const SurfaceTree& tree() const { return tree_; }

  private:
    std::shared_ptr<const ScalpMesh> scalp_;
    SurfaceTree tree_;
};

}  // namespace hairloom
