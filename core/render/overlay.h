// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Marks drawn over a finished picture: roots, guides, triangulation, spheres, a brush's ring.

#include <cstdint>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom::render {

/// Laid out as the shader reads it.
struct OverlayVertex {
    Vec4f position_ws = Vec4f(0, 0, 0, 1);  ///< w is ignored
    Vec4f colour = Vec4f(1, 1, 1, 1);       ///< as shown (sRGB), alpha not premultiplied
};

enum class OverlayShape : std::uint32_t {
    points,     ///< discs
    lines,      ///< two vertices each, with round edges
    triangles,  ///< three vertices each, both sides
};

/// Marks of one shape and look.
struct OverlayBatch {
    OverlayShape shape = OverlayShape::lines;
    float size = 1.5f;  ///< pixels: diameter of a point, width of a line
    bool onTop =
        false;  ///< else the meshes hide what is behind them. Hair never does: marks are about what is in it
    std::vector<OverlayVertex> vertices;
};

/// Batches in the order in which they are drawn.
struct Overlay {
    std::vector<OverlayBatch> batches;
};

/// Errors: a number of vertices that makes no whole shapes, numbers that are not finite, a size outside
/// 0…1000.
Status check(const Overlay& overlay);

}  // namespace hairloom::render
