// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where labels stand beside their points without covering one another.

#include <optional>
#include <vector>

namespace hairloom {

/// Pixels, y downwards.
struct PixelBox {
    double x = 0, y = 0, width = 0, height = 0;

    bool overlaps(const PixelBox& other) const {
        return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
               other.y < y + height;
    }
    bool contains(const PixelBox& other) const {
        return other.x >= x && other.y >= y && other.x + other.width <= x + width &&
               other.y + other.height <= y + height;
    }
};

struct PixelSegment {
    double x0, y0, x1, y1;
};
/// The part of the segment inside the box, if any (Liang and Barsky 1984).
std::optional<PixelSegment> clipped(const PixelSegment& segment, const PixelBox& box);

struct LabelRequest {
    double x, y;  ///< the point
    double width, height;
};

struct LabelPlace {
    PixelBox box;
    bool far;  ///< wants a line that leads to its point
};

/// One place for each request, in its order: inside the frame, clear of the obstacles and of the labels
/// before it, across as few lines as can be, and near. None where there is no such place.
std::vector<std::optional<LabelPlace>> placeLabels(const std::vector<LabelRequest>& requests,
                                                   const PixelBox& frame,
                                                   const std::vector<PixelBox>& obstacles,
                                                   const std::vector<PixelSegment>& lines);

}  // namespace hairloom
