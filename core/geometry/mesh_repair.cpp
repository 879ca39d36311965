// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxCorners = std::size_t{1} << 29u;  // three corners a triangle stay below 2^31
constexpr float kFarthest = 1e7f;                           // metres

Status checkFaceList(const PolygonSoup& soup) {
    const std::size_t faces = soup.offsets.empty() ? 0 : soup.offsets.size() - 1;
    if (faces == 0 || soup.positions.empty()) return fail("the mesh has no faces", "at least one face");
    if (soup.offsets.front() != 0 || soup.offsets.back() != soup.corners.size() ||
        !std::is_sorted(soup.offsets.begin(), soup.offsets.end()))
        return fail("the list of face sizes does not add up to the number of corners");
    if (soup.corners.size() > kMaxCorners || soup.positions.size() > kMaxCorners)
        return fail(fmt::format("the mesh has {} corners and {} vertices", soup.corners.size(),
                                soup.positions.size()),
                    fmt::format("at most {} of each", kMaxCorners));
    const auto fits = [](std::size_t size, std::size_t wanted) { return size == 0 || size == wanted; };
    if (!fits(soup.uvs.size(), soup.corners.size()) || !fits(soup.normals.size(), soup.corners.size()))
        return fail("UVs or normals do not match the number of corners", "one per corner or none");
    if (!fits(soup.faceGroups.size(), faces) || !fits(soup.faceMaterials.size(), faces))
        return fail("groups or materials do not match the number of faces", "one per face or none");
    return {};
}

Status checkIndices(const PolygonSoup& soup) {
    for (std::size_t f = 0; f + 1 < soup.offsets.size(); ++f)
        for (std::size_t c = soup.offsets[f]; c < soup.offsets[f + 1]; ++c)
            if (soup.corners[c] >= soup.positions.size())
                return fail(fmt::format("face {} refers to vertex {}", f, soup.corners[c]),
                            fmt::format("an index below {}", soup.positions.size()));
    const auto checkNames = [](const std::vector<std::uint32_t>& indices, std::size_t names,
                               const char* kind) -> Status {
        for (std::size_t f = 0; f < indices.size(); ++f)
            if (indices[f] >= names)
                return fail(fmt::format("face {} refers to {} {}", f, kind, indices[f]),
                            fmt::format("an index below {}", names));
        return {};
    };
    if (Status status = checkNames(soup.faceGroups, soup.groupNames.size(), "group"); !status) return status;
    return checkNames(soup.faceMaterials, soup.materialNames.size(), "material");
}

Status checkPositions(const PolygonSoup& soup) {
    for (std::size_t v = 0; v < soup.positions.size(); ++v) {
        const Vec3f& p = soup.positions[v];
        if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthest)
            return fail(fmt::format("vertex {} lies at ({}, {}, {})", v, p.x(), p.y(), p.z()),
                        fmt::format("finite coordinates within {} metres", kFarthest));
    }
    return {};
}

std::uint64_t hashPosition(const Vec3f& p) {
    const std::uint64_t xy = (static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(p.x())) << 32u) |
                             std::bit_cast<std::uint32_t>(p.y());
    return Random::mix(Random::mix(xy) ^ std::bit_cast<std::uint32_t>(p.z()));
}

/// Fills positions and sourceVertices with the distinct positions that corners use; returns soup vertex →
/// vertex.
std::vector<std::uint32_t> weld(const PolygonSoup& soup, RepairedTriangles& mesh) {
    std::vector<bool> used(soup.positions.size(), false);
    for (const std::uint32_t corner : soup.corners) used[corner] = true;
    const std::size_t slots = std::bit_ceil(soup.positions.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kNone), vertexOf(soup.positions.size(), kNone);
    std::size_t unused = 0;
    for (std::uint32_t v = 0; v < soup.positions.size(); ++v) {
        if (!used[v]) {
            ++unused;
            continue;
        }
        const Vec3f position = soup.positions[v] + Vec3f::Zero();  // −0 + 0 = +0, so that both hash alike
        std::size_t slot = hashPosition(position) & (slots - 1);
        while (table[slot] != kNone && mesh.positions[table[slot]] != position)
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == kNone) {
            table[slot] = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(position);
            mesh.sourceVertices.push_back(v);
        }
        vertexOf[v] = table[slot];
    }
    mesh.note("vertices without a face dropped", unused);
    mesh.note("duplicate vertices welded", soup.positions.size() - unused - mesh.positions.size());
    return vertexOf;
}

/// The corners of face f without those that repeat their predecessor's position.
void distinctCorners(const PolygonSoup& soup, std::size_t f, const std::vector<std::uint32_t>& vertexOf,
                     std::vector<std::uint32_t>& corners) {
    corners.clear();
    for (std::uint32_t c = soup.offsets[f]; c < soup.offsets[f + 1]; ++c)
        if (corners.empty() || vertexOf[soup.corners[c]] != vertexOf[soup.corners[corners.back()]])
            corners.push_back(c);
    while (corners.size() > 1 &&
           vertexOf[soup.corners[corners.front()]] == vertexOf[soup.corners[corners.back()]])
        corners.pop_back();
}

void cutFaces(const PolygonSoup& soup, const std::vector<std::uint32_t>& vertexOf, RepairedTriangles& mesh) {
    std::size_t degenerate = 0, polygons = 0, crossings = 0;
    std::vector<std::uint32_t> corners;
    std::vector<Vec3f> outline;
    for (std::uint32_t f = 0; f + 1 < soup.offsets.size(); ++f) {
        distinctCorners(soup, f, vertexOf, corners);
        if (corners.size() < 3) {
            ++degenerate;
            continue;
        }
        outline.clear();
        for (const std::uint32_t c : corners) outline.push_back(mesh.positions[vertexOf[soup.corners[c]]]);
        bool crossing = false;
        const std::vector<Triangle> pieces = triangulatePolygon(outline, crossing);
        polygons += corners.size() > 3;
        crossings += crossing;
        for (const Triangle& piece : pieces) {
            if (isDegenerate(outline[piece[0]], outline[piece[1]], outline[piece[2]])) {
                ++degenerate;
                continue;
            }
            const Triangle source{corners[piece[0]], corners[piece[1]], corners[piece[2]]};
            mesh.triangles.push_back({vertexOf[soup.corners[source[0]]], vertexOf[soup.corners[source[1]]],
                                      vertexOf[soup.corners[source[2]]]});
            mesh.sourceCorners.push_back(source);
            mesh.sourceFaces.push_back(f);
        }
    }
    mesh.note("polygons triangulated", polygons);
    mesh.note("polygons with a self-intersecting outline triangulated as fans", crossings);
    mesh.note("degenerate faces dropped", degenerate);
}

/// Keeps the first of triangles over the same three vertices, whatever their winding.
void dropRepeats(RepairedTriangles& mesh) {
    struct Keyed {
        Triangle sorted;
        std::uint32_t triangle;
        auto operator<=>(const Keyed&) const = default;
    };
    std::vector<Keyed> keyed;
    keyed.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Triangle sorted = mesh.triangles[t];
        std::sort(sorted.begin(), sorted.end());
        keyed.push_back({sorted, t});
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<bool> repeated(mesh.triangles.size(), false);
    for (std::size_t i = 1; i < keyed.size(); ++i)
        if (keyed[i].sorted == keyed[i - 1].sorted) repeated[keyed[i].triangle] = true;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (repeated[t]) continue;
        mesh.triangles[kept] = mesh.triangles[t];
        mesh.sourceCorners[kept] = mesh.sourceCorners[t];
        mesh.sourceFaces[kept] = mesh.sourceFaces[t];
        ++kept;
    }
    mesh.note("repeated faces dropped", mesh.triangles.size() - kept);
    mesh.triangles.resize(kept);
    mesh.sourceCorners.resize(kept);
    mesh.sourceFaces.resize(kept);
}

}  // namespace

Result<RepairedTriangles> repairTriangles(const PolygonSoup& soup) {
    for (const auto check : {checkFaceList, checkIndices, checkPositions})
        if (Status status = check(soup); !status) return tl::unexpected(status.error());
    RepairedTriangles mesh;
    const std::vector<std::uint32_t> vertexOf = weld(soup, mesh);
    cutFaces(soup, vertexOf, mesh);
    dropRepeats(mesh);
    if (mesh.triangles.empty())
        return fail("every face of the mesh is degenerate", "at least one triangle with an area");
    makeManifold(mesh);
    return mesh;
}

}  // namespace hairloom
