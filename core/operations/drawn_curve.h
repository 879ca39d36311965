// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A curve that is drawn for an operation: a parting, the middle of a braid, what hair is drawn to.

#include <vector>

#include "core/base/math.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {

/// Points that the curve leads through, metres, in the scalp's rest space. None: nothing was drawn, and the
/// operation does nothing.
struct DrawnCurve {
    std::vector<Vec3f> points;
};
inline constexpr std::size_t kMaxCurvePoints = 64;

/// The member "curve", an array of points; none where it is absent. Complaints are the reader's: one point
/// alone, more than kMaxCurvePoints, coordinates out of range.
DrawnCurve readCurve(JsonReader& reader);
nlohmann::ordered_json toJson(const DrawnCurve& curve);

/// The curve, smooth between its points (Catmull-Rom).
class CurveLine {
  public:
    /// Of at least two points that do not all coincide.
    explicit CurveLine(const DrawnCurve& curve);
    static bool isDrawn(const DrawnCurve& curve);

    float length() const { return arcs_.back(); }
    Vec3f at(float arc) const;
    /// Unit length.
    Vec3f directionAt(float arc) const;
    struct Nearest {
        Vec3f point;
        Vec3f direction;
        float arc;
        float distance;
    };
    Nearest nearest(const Vec3f& to) const;
    std::span<const Vec3f> points() const { return points_; }

  private:
    std::size_t segmentAt(float arc) const;

    std::vector<Vec3f> points_;
    std::vector<float> arcs_;  ///< metres from the beginning to each point
};

}  // namespace hairloom
