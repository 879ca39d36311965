// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How roots move with a deforming mesh.

#include <span>
#include <vector>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// The rigid motion of each root from rest: the posed triangle's frame against the resting one's, about the
/// root's point. `positions_ws` has one entry per vertex of the mesh. A triangle that is flat at rest or
/// posed gives the motion without rotation.
std::vector<Eigen::Isometry3f> rootTransforms(const ScalpMesh& mesh, std::span<const Vec3f> positions_ws,
                                              std::span<const SurfacePoint> roots);

}  // namespace hairloom
