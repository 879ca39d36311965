// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/reshape.h"

#include <algorithm>
#include <vector>

#include "core/geometry/curve.h"
#include "core/operations/length_constraint.h"

namespace hairloom {
namespace {

void growStraightUp(std::span<Vec3f> points, float length) {
    for (std::size_t i = 1; i < points.size(); ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(points.size() - 1);
        points[i] = points[0] + Vec3f(0, length * t, 0);
    }
}

}  // namespace

Vec3f pointAlong(std::span<const Vec3f> points, float t) {
    const float x = t * static_cast<float>(points.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), points.size() - 2);
    const float local = x - static_cast<float>(i);
    return points[i] * (1 - local) + points[i + 1] * local;
}

void scaleToLength(std::span<Vec3f> points, float length) {
    const float now = polylineLength(points);
    if (!(now > 0)) return growStraightUp(points, length);
    const float scale = length / now;
    const Vec3f root = points[0];
    for (Vec3f& point : points.subspan(1)) point = root + (point - root) * scale;
}

void cutOrExtend(std::span<Vec3f> points, float length) {
    const float now = polylineLength(points);
    if (!(now > 0)) return growStraightUp(points, length);
    std::vector<Vec3f> path(points.begin(), points.end());
    if (length > now) {
        const Vec3f last = path[path.size() - 1] - path[path.size() - 2];
        path.push_back(path.back() + last.normalized() * (length - now));
    } else {
        float left = length;
        std::size_t kept = 1;
        while (kept + 1 < path.size() && (path[kept] - path[kept - 1]).norm() < left) {
            left -= (path[kept] - path[kept - 1]).norm();
            ++kept;
        }
        const Vec3f end = path[kept - 1] + (path[kept] - path[kept - 1]).normalized() * left;
        path.resize(kept);
        path.push_back(end);
    }
    const std::vector<Vec3f> even = resampleEvenly(path, points.size());
    std::copy(even.begin() + 1, even.end(), points.begin() + 1);
    const std::vector<float> lengths(points.size() - 1, length / static_cast<float>(points.size() - 1));
    restoreLengthsByDirection(points, lengths);
}

}  // namespace hairloom
