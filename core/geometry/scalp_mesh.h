// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The mesh that hair grows on: triangles with connectivity, per-corner UVs and named groups and materials.

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom {

using Triangle = std::array<std::uint32_t, 3>;

/// What a reader found in a file, before repair. Polygons of any size, positions shared between them.
struct PolygonSoup {
    std::vector<Vec3f> positions;              ///< metres, Y up
    std::vector<std::uint32_t> offsets{0};     ///< face f owns corners [offsets[f], offsets[f+1])
    std::vector<std::uint32_t> corners;        ///< vertex of each corner, counter-clockwise from outside
    std::vector<Vec2f> uvs;                    ///< per corner, or empty
    std::vector<Vec3f> normals;                ///< per corner, or empty
    std::vector<std::uint32_t> faceGroups;     ///< per face, index into groupNames, or empty (all group 0)
    std::vector<std::uint32_t> faceMaterials;  ///< per face, index into materialNames, or empty
    std::vector<std::string> groupNames;
    std::vector<std::string> materialNames;
};

/// One kind of repair and how often it was needed.
struct MeshRepair {
    std::string what;  ///< "duplicate vertices welded", "degenerate faces dropped", …
    std::size_t count;
};

/// The stored arrays of a ScalpMesh; what its accessors of the same names return.
struct ScalpMeshParts {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<Triangle> triangles;
    std::vector<Vec2f> cornerUvs;
    std::vector<std::uint32_t> sourceFaces;
    std::vector<std::uint32_t> sourceVertices;
    std::vector<std::uint32_t> triangleGroups;
    std::vector<std::uint32_t> triangleMaterials;
    std::vector<std::string> groupNames;
    std::vector<std::string> materialNames;
    std::vector<MeshRepair> repairs;
};

/// A triangle mesh whose every edge has at most two faces of consistent orientation and whose every vertex
/// has one fan. Immutable once made, so that documents share it.
class ScalpMesh {
  public:
    struct Traits : OpenMesh::DefaultTraits {
        using Point = OpenMesh::Vec3f;
        using Normal = OpenMesh::Vec3f;
        VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
        FaceAttributes(OpenMesh::Attributes::Status);
        HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
        EdgeAttributes(OpenMesh::Attributes::Status);
    };
    using Connectivity = OpenMesh::TriMesh_ArrayKernelT<Traits>;

    /// Repairs what can be repaired without guessing (welds equal positions, drops degenerate and repeated
    /// faces, splits non-manifold edges and vertices, turns n-gons into triangles, computes missing normals)
    /// and lists it. Errors: no face left, a corner that names no vertex, a coordinate that is not finite.
    static Result<ScalpMesh> make(const PolygonSoup& soup);

    /// The mesh that had these arrays, in the same order and unrepaired, as project files keep it. Errors:
    /// lengths that do not fit each other, indices out of range, values that are not finite, connectivity
    /// that make() would have had to repair.
    static Result<ScalpMesh> fromParts(ScalpMeshParts parts);

    ScalpMesh() = default;

    /// The same mesh with its vertices elsewhere (as many as there are) and normals to match.
    ScalpMesh moved(std::vector<Vec3f> positions) const;

    std::size_t vertexCount() const { return positions_.size(); }
    std::size_t triangleCount() const { return triangles_.size(); }

    std::span<const Vec3f> positions() const { return positions_; }     ///< per vertex, metres
    std::span<const Vec3f> normals() const { return normals_; }         ///< per vertex, unit length
    std::span<const Triangle> triangles() const { return triangles_; }  ///< vertex indices, counter-clockwise
    std::span<const Vec2f> cornerUvs() const { return cornerUvs_; }     ///< 3 per triangle, or empty

    /// The polygon of the file that a triangle was cut from, counted from 0 in file order.
    std::span<const std::uint32_t> sourceFaces() const { return sourceFaces_; }
    /// The vertex of the file (first of those welded) that each vertex came from; skinning weights follow it.
    std::span<const std::uint32_t> sourceVertices() const { return sourceVertices_; }

    std::span<const std::uint32_t> triangleGroups() const { return triangleGroups_; }
    std::span<const std::uint32_t> triangleMaterials() const { return triangleMaterials_; }
    const std::vector<std::string>& groupNames() const { return groupNames_; }
    const std::vector<std::string>& materialNames() const { return materialNames_; }

    /// Halfedges: face handle f is triangle f, vertex handle v is vertex v.
    const Connectivity& connectivity() const { return connectivity_; }

    const std::vector<MeshRepair>& repairs() const { return repairs_; }

    Box3f bounds() const;
    float triangleArea(std::uint32_t triangle) const;    ///< m²
    Vec3f triangleNormal(std::uint32_t triangle) const;  ///< unit length, from the corners
    Vec3f pointAt(std::uint32_t triangle, const Vec3f& barycentric) const;
    Vec3f normalAt(std::uint32_t triangle, const Vec3f& barycentric) const;  ///< interpolated, unit length
    Vec2f uvAt(std::uint32_t triangle, const Vec3f& barycentric) const;      ///< (0, 0) without UVs

  private:
    std::vector<Vec3f> positions_;
    std::vector<Vec3f> normals_;
    std::vector<Triangle> triangles_;
    std::vector<Vec2f> cornerUvs_;
    std::vector<std::uint32_t> sourceFaces_;
    std::vector<std::uint32_t> sourceVertices_;
    std::vector<std::uint32_t> triangleGroups_;
    std::vector<std::uint32_t> triangleMaterials_;
    std::vector<std::string> groupNames_;
    std::vector<std::string> materialNames_;
    std::vector<MeshRepair> repairs_;
    Connectivity connectivity_;
};

/// A point on the surface. Barycentrics are ≥ 0 and add up to 1; corner i of the triangle has weight i.
struct SurfacePoint {
    std::uint32_t triangle = 0;
    Vec3f barycentric = Vec3f(1, 0, 0);
};

/// Triangles of a scalp, ascending and without repeats.
using FaceSet = std::vector<std::uint32_t>;

}  // namespace hairloom
