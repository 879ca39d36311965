// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/surface_disc.h"

#include <algorithm>
#include <optional>

namespace hairloom::editing {
namespace {

Vec3f middleOf(const ScalpMesh& mesh, std::uint32_t face) {
    return mesh.pointAt(face, Vec3f::Constant(1.0f / 3));
}

/// Square of the distance from a point to a triangle, closely enough to find one's way over neighbours: to
/// its corners, its middle and the middles of its edges.
float squaredDistance(const ScalpMesh& mesh, std::uint32_t face, const Vec3f& point) {
    float nearest = (middleOf(mesh, face) - point).squaredNorm();
    const Triangle& t = mesh.triangles()[face];
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3f& a = mesh.positions()[t[i]];
        const Vec3f& b = mesh.positions()[t[(i + 1) % 3]];
        nearest = std::min({nearest, (a - point).squaredNorm(), (0.5f * (a + b) - point).squaredNorm()});
    }
    return nearest;
}

/// All faces that are reached over neighbours that come within the radius; in order of discovery.
FaceSet flood(const ScalpMesh& mesh, std::uint32_t seed, const Vec3f& centre, float radius) {
    FaceSet reached{seed};
    std::vector<bool> seen(mesh.triangleCount(), false);
    seen[seed] = true;
    const ScalpMesh::Connectivity& connectivity = mesh.connectivity();
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const OpenMesh::FaceHandle face(static_cast<int>(reached[i]));
        for (const auto halfedge : connectivity.fh_range(face)) {
            const auto across = connectivity.opposite_face_handle(halfedge);
            if (!across.is_valid()) continue;
            const auto next = static_cast<std::uint32_t>(across.idx());
            if (seen[next] || squaredDistance(mesh, next, centre) >= radius * radius) continue;
            seen[next] = true;
            reached.push_back(next);
        }
    }
    return reached;
}

/// The face under a point, or none where it lies farther than the radius from the surface.
std::optional<std::uint32_t> faceUnder(const SurfaceTree& tree, const Vec3f& centre, float radius) {
    const SurfaceTree::Hit hit = tree.closest(centre);
    if (!(hit.distance <= radius)) return std::nullopt;
    return hit.surface.triangle;
}

}  // namespace

FaceSet faceDisc(const ScalpMesh& mesh, const SurfaceTree& tree, const Vec3f& centre, float radius) {
    const auto seed = faceUnder(tree, centre, radius);
    if (!seed) return {};
    FaceSet faces = flood(mesh, *seed, centre, radius);
    std::erase_if(faces, [&](std::uint32_t face) {
        return face != *seed && (middleOf(mesh, face) - centre).squaredNorm() > radius * radius;
    });
    std::sort(faces.begin(), faces.end());
    return faces;
}

VertexDisc vertexDisc(const ScalpMesh& mesh, const SurfaceTree& tree, const Vec3f& centre, float radius) {
    VertexDisc disc;
    const auto seed = faceUnder(tree, centre, radius);
    if (!seed) return disc;
    for (const std::uint32_t face : flood(mesh, *seed, centre, radius)) {
        for (const std::uint32_t v : mesh.triangles()[face]) {
            if ((mesh.positions()[v] - centre).norm() < radius) disc.vertices.push_back(v);
        }
    }
    std::sort(disc.vertices.begin(), disc.vertices.end());
    disc.vertices.erase(std::unique(disc.vertices.begin(), disc.vertices.end()), disc.vertices.end());
    for (const std::uint32_t v : disc.vertices)
        disc.distances.push_back((mesh.positions()[v] - centre).norm());
    return disc;
}

FaceSet symmetricFaces(const ScalpMesh& mesh, const SurfaceTree& tree, const FaceSet& faces,
                       const Vec3f& planePoint, const Vec3f& planeNormal) {
    const Vec3f normal = planeNormal.normalized();
    FaceSet both = faces;
    for (const std::uint32_t face : faces) {
        const Vec3f middle = middleOf(mesh, face);
        const Vec3f mirror = middle - 2 * (middle - planePoint).dot(normal) * normal;
        both.push_back(tree.closest(mirror).surface.triangle);
    }
    std::sort(both.begin(), both.end());
    both.erase(std::unique(both.begin(), both.end()), both.end());
    return both;
}

}  // namespace hairloom::editing
