// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/drawn_curve.h"

#include <algorithm>

#include "core/geometry/curve.h"
#include "core/operations/strand_edit.h"
#include "core/operations/strand_frames.h"

namespace hairloom {

DrawnCurve readCurve(JsonReader& reader) {
    DrawnCurve curve;
    if (!reader.has("curve")) return curve;
    curve.points = reader.vectors("curve", -kAnywhere, kAnywhere, kMaxCurvePoints);
    if (curve.points.size() == 1)
        reader.complain("curve", "has one point", "expected no points, or at least two");
    return curve;
}

nlohmann::ordered_json toJson(const DrawnCurve& curve) {
    auto points = nlohmann::ordered_json::array();
    for (const Vec3f& point : curve.points) points.push_back(valueToJson(point));
    return points;
}

bool CurveLine::isDrawn(const DrawnCurve& curve) {
    return curve.points.size() >= 2 && polylineLength(curve.points) > 0;
}

CurveLine::CurveLine(const DrawnCurve& curve) {
    constexpr std::size_t kPieces = 8;  ///< of a segment between drawn points
    const std::size_t count = (curve.points.size() - 1) * kPieces + 1;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = static_cast<float>(i) / static_cast<float>(count - 1);
        points_.push_back(catmullRom(curve.points, x));
    }
    arcs_.assign(1, 0);
    for (std::size_t i = 1; i < count; ++i)
        arcs_.push_back(arcs_.back() + (points_[i] - points_[i - 1]).norm());
}

std::size_t CurveLine::segmentAt(float arc) const {
    const auto behind = std::upper_bound(arcs_.begin() + 1, arcs_.end() - 1, arc);
    return static_cast<std::size_t>(behind - arcs_.begin()) - 1;
}

Vec3f CurveLine::at(float arc) const {
    const std::size_t i = segmentAt(arc);
    const float length = arcs_[i + 1] - arcs_[i];
    const float t = length > 0 ? std::clamp((arc - arcs_[i]) / length, 0.0f, 1.0f) : 0.0f;
    return points_[i] + t * (points_[i + 1] - points_[i]);
}

Vec3f CurveLine::directionAt(float arc) const {
    const std::size_t i = segmentAt(arc);
    return unitOr(points_[i + 1] - points_[i], unitOr(points_.back() - points_.front(), -Vec3f::UnitY()));
}

CurveLine::Nearest CurveLine::nearest(const Vec3f& to) const {
    Nearest best{points_[0], directionAt(0), 0, (to - points_[0]).norm()};
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        const Vec3f along = points_[i + 1] - points_[i];
        const float square = along.squaredNorm();
        if (!(square > 0)) continue;
        const float t = std::clamp((to - points_[i]).dot(along) / square, 0.0f, 1.0f);
        const Vec3f point = points_[i] + t * along;
        const float distance = (to - point).norm();
        if (!(distance < best.distance)) continue;
        best = {point, along / std::sqrt(square), arcs_[i] + t * std::sqrt(square), distance};
    }
    return best;
}

}  // namespace hairloom
