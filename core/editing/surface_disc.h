// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The part of a head's surface around a point that hangs together, and what lies opposite.

#include <span>
#include <vector>

#include "core/geometry/closest_point.h"

namespace hairloom::editing {

/// Faces whose middle is within `radius` metres of the point and that can be reached from the face under it
/// over faces that come as near; that face itself in any case. Ascending. So a disc on an ear does not reach
/// the skin behind it.
FaceSet faceDisc(const ScalpMesh& mesh, const SurfaceTree& tree, const Vec3f& centre, float radius);

/// The same for vertices, with the distance of each.
struct VertexDisc {
    std::vector<std::uint32_t> vertices;  ///< ascending
    std::vector<float> distances;         ///< metres, below `radius`
};
VertexDisc vertexDisc(const ScalpMesh& mesh, const SurfaceTree& tree, const Vec3f& centre, float radius);

/// The faces that lie nearest to the mirror images of these faces' middles, with these; ascending. The plane
/// is x = 0 by default.
FaceSet symmetricFaces(const ScalpMesh& mesh, const SurfaceTree& tree, const FaceSet& faces,
                       const Vec3f& planePoint = Vec3f::Zero(), const Vec3f& planeNormal = Vec3f::UnitX());

}  // namespace hairloom::editing
