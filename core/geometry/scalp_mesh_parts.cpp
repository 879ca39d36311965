// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {
namespace {

template <class T>
bool allFinite(const std::vector<T>& vectors) {
    return std::all_of(vectors.begin(), vectors.end(), [](const T& v) { return v.allFinite(); });
}

Status checkLengths(const ScalpMeshParts& parts) {
    const std::size_t vertices = parts.positions.size();
    const std::size_t triangles = parts.triangles.size();
    const auto expect = [](std::string_view what, std::size_t found, std::size_t wanted,
                           bool mayBeEmpty) -> Status {
        if (found == wanted || (mayBeEmpty && found == 0)) return {};
        return fail(fmt::format("the scalp mesh has {} {}", found, what), fmt::format("expected {}", wanted));
    };
    if (triangles == 0) return fail("the scalp mesh has no triangles", "expected a mesh with faces");
    Status status = expect("normals", parts.normals.size(), vertices, false);
    if (status) status = expect("corner UVs", parts.cornerUvs.size(), 3 * triangles, true);
    if (status) status = expect("source faces", parts.sourceFaces.size(), triangles, false);
    if (status) status = expect("source vertices", parts.sourceVertices.size(), vertices, false);
    if (status) status = expect("triangle groups", parts.triangleGroups.size(), triangles, true);
    if (status) status = expect("triangle materials", parts.triangleMaterials.size(), triangles, true);
    return status;
}

Status checkIndices(std::string_view what, const std::vector<std::uint32_t>& indices, std::size_t names) {
    const std::size_t limit = std::max<std::size_t>(names, 1);
    const auto bad =
        std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= limit; });
    if (bad == indices.end()) return {};
    return fail(fmt::format("triangle {} of the scalp mesh is of {} {}", bad - indices.begin(), what, *bad),
                fmt::format("there are {}", names));
}

/// Each directed edge once, and at most one boundary edge leaving each vertex.
Status checkManifold(const ScalpMeshParts& parts) {
    std::vector<std::uint64_t> edges;
    edges.reserve(3 * parts.triangles.size());
    for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t from = parts.triangles[t][c];
            const std::uint32_t to = parts.triangles[t][(c + 1) % 3];
            if (from >= parts.positions.size() || from == to) {
                return fail(
                    fmt::format("triangle {} of the scalp mesh has corner {}", t, from),
                    fmt::format("expected three different vertices below {}", parts.positions.size()));
            }
            edges.push_back((std::uint64_t{from} << 32u) | to);
        }
    }
    std::sort(edges.begin(), edges.end());
    if (const auto twice = std::adjacent_find(edges.begin(), edges.end()); twice != edges.end()) {
        return fail(fmt::format("the edge from vertex {} to {} of the scalp mesh is used twice",
                                *twice >> 32u, *twice & 0xffffffffu),
                    "expected faces of one orientation, two at an edge at most");
    }
    std::vector<std::uint8_t> onBoundary(parts.positions.size(), 0);
    for (const std::uint64_t edge : edges) {
        const std::uint64_t opposite = (edge << 32u) | (edge >> 32u);
        if (std::binary_search(edges.begin(), edges.end(), opposite)) continue;
        std::uint8_t& seen = onBoundary[edge >> 32u];
        if (seen) {
            return fail(
                fmt::format("vertex {} of the scalp mesh joins several fans of triangles", edge >> 32u),
                "expected one");
        }
        seen = 1;
    }
    return {};
}

}  // namespace

Result<ScalpMesh> ScalpMesh::fromParts(ScalpMeshParts parts) {
    Status status = checkLengths(parts);
    if (status) status = checkIndices("group", parts.triangleGroups, parts.groupNames.size());
    if (status) status = checkIndices("material", parts.triangleMaterials, parts.materialNames.size());
    if (status) status = checkManifold(parts);
    if (!status) return tl::unexpected(status.error());
    if (!allFinite(parts.positions) || !allFinite(parts.normals) || !allFinite(parts.cornerUvs)) {
        return fail("the scalp mesh has a coordinate that is not finite", "expected finite numbers");
    }
    ScalpMesh mesh;
    mesh.connectivity_.reserve(parts.positions.size(), 3 * parts.triangles.size() / 2,
                               parts.triangles.size());
    for (std::size_t v = 0; v < parts.positions.size(); ++v) {
        const Vec3f& p = parts.positions[v];
        const Vec3f& n = parts.normals[v];
        const auto handle = mesh.connectivity_.add_vertex({p.x(), p.y(), p.z()});
        mesh.connectivity_.set_normal(handle, {n.x(), n.y(), n.z()});
    }
    for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
        const auto vertex = [&](std::size_t c) {
            return OpenMesh::VertexHandle(static_cast<int>(parts.triangles[t][c]));
        };
        if (!mesh.connectivity_.add_face(vertex(0), vertex(1), vertex(2)).is_valid()) {
            return fail(fmt::format("triangle {} of the scalp mesh closes a second fan at a vertex", t),
                        "expected one fan at each vertex");
        }
    }
    mesh.positions_ = std::move(parts.positions);
    mesh.normals_ = std::move(parts.normals);
    mesh.triangles_ = std::move(parts.triangles);
    mesh.cornerUvs_ = std::move(parts.cornerUvs);
    mesh.sourceFaces_ = std::move(parts.sourceFaces);
    mesh.sourceVertices_ = std::move(parts.sourceVertices);
    mesh.triangleGroups_ = std::move(parts.triangleGroups);
    mesh.triangleMaterials_ = std::move(parts.triangleMaterials);
    mesh.groupNames_ = std::move(parts.groupNames);
    mesh.materialNames_ = std::move(parts.materialNames);
    mesh.repairs_ = std::move(parts.repairs);
    return mesh;
}

}  // namespace hairloom
