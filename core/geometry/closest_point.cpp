// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/closest_point.h"

#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/triangle_tree.h"

namespace hairloom {
namespace {

double angleAt(const ScalpMesh& mesh, const Triangle& t, std::uint32_t vertex) {
    const std::size_t i = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    const auto position = [&](std::size_t k) -> Vec3d { return mesh.positions()[t[k % 3]].cast<double>(); };
    const Vec3d a = position(i + 1) - position(i), b = position(i + 2) - position(i);
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The normal whose side tells inside from outside at a corner, on an edge or within a face (Bærentzen and
/// Aanæs 2005).
Vec3f pseudoNormalAt(const ScalpMesh& mesh, const SurfacePoint& point) {
    constexpr float kOnEdge = 1e-6f;
    const Triangle& triangle = mesh.triangles()[point.triangle];
    const ScalpMesh::Connectivity& connectivity = mesh.connectivity();
    for (int i = 0; i < 3; ++i) {
        if (point.barycentric[i] < 1 - kOnEdge) continue;
        const std::uint32_t vertex = triangle[static_cast<std::size_t>(i)];
        Vec3d sum = Vec3d::Zero();
        for (const auto face : connectivity.vf_range(OpenMesh::VertexHandle(static_cast<int>(vertex)))) {
            const auto f = static_cast<std::uint32_t>(face.idx());
            sum += angleAt(mesh, mesh.triangles()[f], vertex) * mesh.triangleNormal(f).cast<double>();
        }
        return sum.cast<float>();
    }
    Vec3f sum = mesh.triangleNormal(point.triangle);
    for (int i = 0; i < 3; ++i) {
        if (point.barycentric[i] > kOnEdge) continue;
        const auto from =
            OpenMesh::VertexHandle(static_cast<int>(triangle[static_cast<std::size_t>((i + 1) % 3)]));
        const auto to =
            OpenMesh::VertexHandle(static_cast<int>(triangle[static_cast<std::size_t>((i + 2) % 3)]));
        const auto across = connectivity.opposite_face_handle(connectivity.find_halfedge(from, to));
        if (across.is_valid()) sum += mesh.triangleNormal(static_cast<std::uint32_t>(across.idx()));
    }
    return sum;
}

}  // namespace

struct SurfaceTree::Impl {
    const ScalpMesh& mesh;
    FaceSet faces;  ///< empty: triangle i of the tree is triangle i of the mesh
    TriangleTree tree;

    Hit hitOf(const TriangleTree::Hit& hit) const {
        const std::uint32_t face = faces.empty() ? hit.triangle : faces[hit.triangle];
        return {{face, hit.barycentric.cast<float>()},
                hit.position.cast<float>(),
                static_cast<float>(hit.distance)};
    }
};

SurfaceTree::SurfaceTree(const ScalpMesh& mesh, const FaceSet& faces) {
    const std::size_t count = faces.empty() ? mesh.triangleCount() : faces.size();
    std::vector<TriangleTree::Corners> triangles(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle& t = mesh.triangles()[faces.empty() ? i : faces[i]];
        triangles[i] = {mesh.positions()[t[0]], mesh.positions()[t[1]], mesh.positions()[t[2]]};
    }
    impl_.reset(new Impl{mesh, faces, TriangleTree(triangles)});
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;

SurfaceTree::Hit SurfaceTree::closest(const Vec3f& point) const {
    const auto hit = impl_->tree.closest(point);
    return hit ? impl_->hitOf(*hit) : Hit{SurfacePoint{}, point, std::numeric_limits<float>::infinity()};
}

float SurfaceTree::signedDistance(const Vec3f& point) const {
    const Hit hit = closest(point);
    if (!std::isfinite(hit.distance)) return hit.distance;
    const Vec3f normal = pseudoNormalAt(impl_->mesh, hit.surface);
    return (point - hit.position).dot(normal) < 0 ? -hit.distance : hit.distance;
}

std::optional<SurfaceTree::Hit> SurfaceTree::firstHit(const Vec3f& origin, const Vec3f& direction) const {
    if (!origin.allFinite() || !direction.allFinite() || direction.isZero(0)) return std::nullopt;
    const auto hit = impl_->tree.firstHit(origin, direction.normalized());
    if (!hit) return std::nullopt;
    return impl_->hitOf(*hit);
}

}  // namespace hairloom
