// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Faces of meshes as USD and Alembic files have them, put into the soup of a scene.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "importers/corner_values.h"
#include "importers/raw_scene.h"

namespace hairloom {

/// Faces of one mesh as its file has them; face f owns corners [offsets[f], offsets[f+1]).
struct FileFaces {
    std::vector<std::uint32_t> offsets{0}, corners;
    std::vector<std::uint8_t> isHole;  ///< per face
    std::size_t count() const { return offsets.size() - 1; }
};

/// Points of a mesh, three numbers each, after a transform.
std::vector<Vec3f> pointsIn(std::span<const float> numbers, const Eigen::Affine3d& toWorld);

/// What one mesh's faces have, and where they go.
struct FacesInScene {
    std::optional<CornerValues> uvs, normals;
    std::vector<std::uint32_t> groups, materials;  ///< per face
    std::uint32_t firstPoint = 0;                  ///< of the mesh in the soup
    Eigen::Affine3d toWorld = Eigen::Affine3d::Identity();
    bool isReversed = false;  ///< corners go clockwise, seen from outside
};

/// Puts the faces of one mesh after another into a scene, and remembers what is to be told of them.
class FaceCollector {
  public:
    /// An error where a mesh's points and corners would be more than are read.
    static Status fits(const PolygonSoup& soup, std::size_t points, std::size_t corners);

    void add(const FileFaces& faces, const FacesInScene& in, PolygonSoup& soup);

    /// Warnings of all meshes; `sets` is what the format calls sets of faces.
    /// Normals go unless every corner has a usable one.
    void finish(RawScene& scene, const char* sets) const;

    bool isCage = false;     ///< a mesh is a subdivision surface
    bool isSheared = false;  ///< a transform shears in time
    std::size_t badSetFaces = 0;

  private:
    void addNormal(const float* numbers, const Mat3f& turned, PolygonSoup& soup);

    bool hasNormals_ = true;
    std::size_t meshesWithoutUvs_ = 0, tooFewCorners_ = 0, holes_ = 0, badNormals_ = 0;
};

}  // namespace hairloom
