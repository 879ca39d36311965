// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/closest_point.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <boost/variant/get.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace hairloom {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 toCgal(const Vec3f& p) {
    return {p.x(), p.y(), p.z()};
}
Vec3d toEigen(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

/// Barycentrics of a point of the triangle's plane, clamped to the triangle.
Vec3d barycentricsOf(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    Vec3d weights((c - b).cross(p - b).dot(normal) / area, (a - c).cross(p - c).dot(normal) / area, 0);
    weights.z() = 1 - weights.x() - weights.y();
    weights = weights.cwiseMax(0.0);
    return weights / weights.sum();
}

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
    const ScalpMesh* mesh = nullptr;
    FaceSet faces;  ///< empty: triangle i of the tree is triangle i of the mesh
    Triangles triangles;
    Tree tree;

    SurfacePoint surfacePoint(std::size_t entry, const Vec3d& point) const {
        SurfacePoint surface;
        surface.triangle = faces.empty() ? static_cast<std::uint32_t>(entry) : faces[entry];
        const Kernel::Triangle_3& t = triangles[entry];
        surface.barycentric =
            barycentricsOf(point, toEigen(t[0]), toEigen(t[1]), toEigen(t[2])).cast<float>();
        return surface;
    }
};

SurfaceTree::SurfaceTree(const ScalpMesh& mesh, const FaceSet& faces) : impl_(std::make_unique<Impl>()) {
    impl_->mesh = &mesh;
    impl_->faces = faces;
    const std::size_t count = faces.empty() ? mesh.triangleCount() : faces.size();
    impl_->triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle& t = mesh.triangles()[faces.empty() ? i : faces[i]];
        const auto corner = [&](std::size_t k) { return toCgal(mesh.positions()[t[k]]); };
        impl_->triangles.emplace_back(corner(0), corner(1), corner(2));
    }
    impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
    impl_->tree.build();
    if (count > 0) impl_->tree.accelerate_distance_queries();  // here, so that queries only read
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;

SurfaceTree::Hit SurfaceTree::closest(const Vec3f& point) const {
    if (impl_->triangles.empty() || !point.allFinite())
        return {SurfacePoint{}, point, std::numeric_limits<float>::infinity()};
    const auto [nearest, primitive] = impl_->tree.closest_point_and_primitive(toCgal(point));
    const Vec3d position = toEigen(nearest);
    const auto entry = static_cast<std::size_t>(primitive - impl_->triangles.cbegin());
    return {impl_->surfacePoint(entry, position), position.cast<float>(),
            static_cast<float>((point.cast<double>() - position).norm())};
}

float SurfaceTree::signedDistance(const Vec3f& point) const {
    const Hit hit = closest(point);
    if (!std::isfinite(hit.distance)) return hit.distance;
    const Vec3f normal = pseudoNormalAt(*impl_->mesh, hit.surface);
    return (point - hit.position).dot(normal) < 0 ? -hit.distance : hit.distance;
}

std::optional<SurfaceTree::Hit> SurfaceTree::firstHit(const Vec3f& origin, const Vec3f& direction) const {
    const bool usable = origin.allFinite() && direction.allFinite() && !direction.isZero(0);
    if (impl_->triangles.empty() || !usable) return std::nullopt;
    const Vec3d unit = direction.cast<double>().normalized();
    const Kernel::Ray_3 ray(toCgal(origin), Kernel::Vector_3(unit.x(), unit.y(), unit.z()));
    const auto found = impl_->tree.first_intersection(ray);
    if (!found) return std::nullopt;
    const Vec3d start = origin.cast<double>();
    Vec3d position;
    if (const auto* single = boost::get<Kernel::Point_3>(&found->first)) {
        position = toEigen(*single);
    } else {  // the ray runs along the face
        const auto& overlap = boost::get<Kernel::Segment_3>(found->first);
        const Vec3d a = toEigen(overlap.source()), b = toEigen(overlap.target());
        position = (a - start).squaredNorm() <= (b - start).squaredNorm() ? a : b;
    }
    const auto entry = static_cast<std::size_t>(found->second - impl_->triangles.cbegin());
    return Hit{impl_->surfacePoint(entry, position), position.cast<float>(),
               static_cast<float>((position - start).norm())};
}

}  // namespace hairloom
