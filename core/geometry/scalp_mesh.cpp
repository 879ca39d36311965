// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/scalp_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/geometry/mesh_repair.h"

namespace hairloom {
namespace {

Vec3d edgeBetween(const std::vector<Vec3f>& positions, std::uint32_t from, std::uint32_t to) {
    return positions[to].cast<double>() - positions[from].cast<double>();
}

/// Face normals weighted by the angle at the vertex (Thürmer and Wüthrich 1998). Never zero.
std::vector<Vec3d> angleWeightedNormals(const std::vector<Vec3f>& positions,
                                        const std::vector<Triangle>& triangles) {
    std::vector<Vec3d> sums(positions.size(), Vec3d::Zero()), anyNormal(positions.size(), Vec3d::UnitY());
    for (const Triangle& triangle : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d a = edgeBetween(positions, triangle[i], triangle[(i + 1) % 3]).normalized();
            const Vec3d b = edgeBetween(positions, triangle[i], triangle[(i + 2) % 3]).normalized();
            const Vec3d cross = a.cross(b);
            const Vec3d normal = cross.normalized();
            sums[triangle[i]] += normal * std::atan2(cross.norm(), a.dot(b));
            anyNormal[triangle[i]] = normal;
        }
    constexpr double kCancelled = 1e-9;
    for (std::size_t v = 0; v < sums.size(); ++v)
        sums[v] = sums[v].norm() > kCancelled ? sums[v].normalized().eval() : anyNormal[v];
    return sums;
}

/// Means of the file's normals; computed ones where it has none that are usable.
std::vector<Vec3f> vertexNormals(const PolygonSoup& soup, RepairedTriangles& mesh) {
    const std::vector<Vec3d> computed = angleWeightedNormals(mesh.positions, mesh.triangles);
    std::vector<Vec3d> given(mesh.positions.size(), Vec3d::Zero());
    if (!soup.normals.empty())
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3d normal = soup.normals[mesh.sourceCorners[t][i]].cast<double>();
                if (normal.allFinite() && normal.norm() > 0)
                    given[mesh.triangles[t][i]] += normal.normalized();
            }
    std::vector<Vec3f> normals(mesh.positions.size());
    std::size_t missing = 0;
    constexpr double kCancelled = 1e-3;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const bool usable = given[v].norm() > kCancelled;
        missing += !usable;
        normals[v] = (usable ? given[v].normalized().eval() : computed[v]).cast<float>();
    }
    mesh.note("missing normals computed", missing);
    return normals;
}

std::vector<Vec2f> cornerUvsOf(const PolygonSoup& soup, RepairedTriangles& mesh) {
    std::vector<Vec2f> uvs;
    if (soup.uvs.empty()) return uvs;
    uvs.reserve(mesh.triangles.size() * 3);
    std::size_t broken = 0;
    for (const Triangle& source : mesh.sourceCorners)
        for (const std::uint32_t corner : source) {
            const bool finite = soup.uvs[corner].allFinite();
            broken += !finite;
            uvs.push_back(finite ? soup.uvs[corner] : Vec2f(0, 0));
        }
    mesh.note("UVs that are not finite set to zero", broken);
    return uvs;
}

std::vector<std::uint32_t> spreadOverTriangles(const std::vector<std::uint32_t>& perFace,
                                               const std::vector<std::uint32_t>& sourceFaces) {
    std::vector<std::uint32_t> perTriangle(sourceFaces.size(), 0);
    if (!perFace.empty())
        for (std::size_t t = 0; t < sourceFaces.size(); ++t) perTriangle[t] = perFace[sourceFaces[t]];
    return perTriangle;
}

std::vector<std::string> namesOrDefault(const std::vector<std::string>& names) {
    return names.empty() ? std::vector<std::string>{"default"} : names;
}

bool buildConnectivity(const RepairedTriangles& mesh, ScalpMesh::Connectivity& connectivity) {
    using Handle = OpenMesh::VertexHandle;
    connectivity.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2 + mesh.positions.size(),
                         mesh.triangles.size());
    for (const Vec3f& p : mesh.positions) connectivity.add_vertex({p.x(), p.y(), p.z()});
    for (const Triangle& triangle : mesh.triangles) {
        const auto handle = [&](std::size_t i) { return Handle(static_cast<int>(triangle[i])); };
        if (!connectivity.add_face(handle(0), handle(1), handle(2)).is_valid()) return false;
    }
    return true;
}

OpenMesh::VertexHandle vertexHandle(std::size_t vertex) {
    return OpenMesh::VertexHandle(static_cast<int>(vertex));
}

void setNormals(const std::vector<Vec3f>& normals, ScalpMesh::Connectivity& connectivity) {
    for (std::size_t v = 0; v < normals.size(); ++v) {
        connectivity.set_normal(vertexHandle(v), {normals[v].x(), normals[v].y(), normals[v].z()});
    }
}

}  // namespace

Result<ScalpMesh> ScalpMesh::make(const PolygonSoup& soup) {
    Result<RepairedTriangles> repaired = repairTriangles(soup);
    if (!repaired) return tl::unexpected(repaired.error());
    ScalpMesh mesh;
    mesh.normals_ = vertexNormals(soup, *repaired);
    mesh.cornerUvs_ = cornerUvsOf(soup, *repaired);
    if (!buildConnectivity(*repaired, mesh.connectivity_))
        return fail("the faces of the mesh cannot be joined to a surface",
                    "edges shared by at most two faces");
    setNormals(mesh.normals_, mesh.connectivity_);
    mesh.triangleGroups_ = spreadOverTriangles(soup.faceGroups, repaired->sourceFaces);
    mesh.triangleMaterials_ = spreadOverTriangles(soup.faceMaterials, repaired->sourceFaces);
    mesh.groupNames_ = namesOrDefault(soup.groupNames);
    mesh.materialNames_ = namesOrDefault(soup.materialNames);
    mesh.positions_ = std::move(repaired->positions);
    mesh.triangles_ = std::move(repaired->triangles);
    mesh.sourceFaces_ = std::move(repaired->sourceFaces);
    mesh.sourceVertices_ = std::move(repaired->sourceVertices);
    mesh.repairs_ = std::move(repaired->repairs);
    return mesh;
}

ScalpMesh ScalpMesh::moved(std::vector<Vec3f> positions) const {
    assert(positions.size() == positions_.size());
    ScalpMesh mesh = *this;
    const std::vector<Vec3d> normals = angleWeightedNormals(positions, triangles_);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        mesh.normals_[v] = normals[v].cast<float>();
        mesh.connectivity_.set_point(vertexHandle(v), {positions[v].x(), positions[v].y(), positions[v].z()});
    }
    setNormals(mesh.normals_, mesh.connectivity_);
    mesh.positions_ = std::move(positions);
    return mesh;
}

Box3f ScalpMesh::bounds() const {
    Box3f box;
    for (const Vec3f& position : positions_) box.extend(position);
    return box;
}

float ScalpMesh::triangleArea(std::uint32_t triangle) const {
    const Triangle& t = triangles_[triangle];
    return static_cast<float>(
        0.5 * edgeBetween(positions_, t[0], t[1]).cross(edgeBetween(positions_, t[0], t[2])).norm());
}

Vec3f ScalpMesh::triangleNormal(std::uint32_t triangle) const {
    const Triangle& t = triangles_[triangle];
    return edgeBetween(positions_, t[0], t[1])
        .cross(edgeBetween(positions_, t[0], t[2]))
        .normalized()
        .cast<float>();
}

Vec3f ScalpMesh::pointAt(std::uint32_t triangle, const Vec3f& barycentric) const {
    const Triangle& t = triangles_[triangle];
    return barycentric.x() * positions_[t[0]] + barycentric.y() * positions_[t[1]] +
           barycentric.z() * positions_[t[2]];
}

Vec3f ScalpMesh::normalAt(std::uint32_t triangle, const Vec3f& barycentric) const {
    const Triangle& t = triangles_[triangle];
    const Vec3f sum = barycentric.x() * normals_[t[0]] + barycentric.y() * normals_[t[1]] +
                      barycentric.z() * normals_[t[2]];
    constexpr float kCancelled = 1e-6f;
    return sum.norm() > kCancelled ? sum.normalized().eval() : triangleNormal(triangle);
}

Vec2f ScalpMesh::uvAt(std::uint32_t triangle, const Vec3f& barycentric) const {
    if (cornerUvs_.empty()) return Vec2f::Zero();
    const std::size_t corner = 3 * std::size_t{triangle};
    return barycentric.x() * cornerUvs_[corner] + barycentric.y() * cornerUvs_[corner + 1] +
           barycentric.z() * cornerUvs_[corner + 2];
}

}  // namespace hairloom
