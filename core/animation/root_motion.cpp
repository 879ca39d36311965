// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/root_motion.h"

#include "core/base/parallel.h"

namespace hairloom {
namespace {

constexpr std::size_t kRootsPerPiece = 4096;

/// A right-handed frame that turns with the triangle: along its first edge, its normal, and across. Zero when
/// flat.
Mat3f triangleFrame(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3f along = b - a;
    const Vec3f normal = along.cross(c - a);
    if (!(normal.norm() > 0) || !(along.norm() > 0)) return Mat3f::Zero();
    Mat3f frame;
    frame.col(0) = along.normalized();
    frame.col(1) = normal.normalized();
    frame.col(2) = frame.col(0).cross(frame.col(1));
    return frame;
}

Mat3f frameOf(const Triangle& triangle, std::span<const Vec3f> positions) {
    return triangleFrame(positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]);
}

Vec3f pointOf(const Triangle& triangle, const Vec3f& barycentric, std::span<const Vec3f> positions) {
    return barycentric.x() * positions[triangle[0]] + barycentric.y() * positions[triangle[1]] +
           barycentric.z() * positions[triangle[2]];
}

}  // namespace

std::vector<Eigen::Isometry3f> rootTransforms(const ScalpMesh& mesh, std::span<const Vec3f> positions_ws,
                                              std::span<const SurfacePoint> roots) {
    std::vector<Eigen::Isometry3f> transforms(roots.size(), Eigen::Isometry3f::Identity());
    parallelFor(roots.size(), kRootsPerPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t root = begin; root < end; ++root) {
            const Triangle& triangle = mesh.triangles()[roots[root].triangle];
            const Mat3f rotation =
                frameOf(triangle, positions_ws) * frameOf(triangle, mesh.positions()).transpose();
            if (!rotation.isZero(0.0f)) transforms[root].linear() = rotation;
            const Vec3f& barycentric = roots[root].barycentric;
            transforms[root].translation() =
                pointOf(triangle, barycentric, positions_ws) -
                transforms[root].linear() * pointOf(triangle, barycentric, mesh.positions());
        }
    });
    return transforms;
}

}  // namespace hairloom
