// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// Where a walk over the surface ends that begins at `from` and is as long as `offset` (metres), straight on
/// from triangle to triangle, as on a sheet that is laid flat. `offset` counts by its part in the plane of
/// the first triangle, of which it takes the direction. The walk enters triangles only whose entry of `open`
/// is not 0 (one a triangle; empty: all), goes along the border of these where it meets it, and stops in a
/// corner.
SurfacePoint walkOnSurface(const ScalpMesh& mesh, const SurfacePoint& from, const Vec3f& offset,
                           std::span<const std::uint8_t> open = {});

}  // namespace hairloom
