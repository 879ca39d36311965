// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/curve.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hairloom {
namespace {

/// Segment and local parameter of x: t = x·n − k, where x = 1 belongs to the last segment (thesis Eq. 55,
/// corrected).
struct Local {
    std::size_t segment;
    float t;
};

Local localParameter(std::size_t segments, float x) {
    const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(segments);
    const std::size_t segment = std::min(static_cast<std::size_t>(scaled), segments - 1);
    return {segment, scaled - static_cast<float>(segment)};
}

/// Ends and tangents of a segment (thesis Eq. 54); missing neighbours repeat the end points.
struct Hermite {
    Vec3f start, end, startTangent, endTangent;
};

Hermite hermiteSegment(std::span<const Vec3f> points, std::size_t k) {
    const Vec3f& before = points[k == 0 ? 0 : k - 1];
    const Vec3f& after = points[std::min(k + 2, points.size() - 1)];
    return {points[k], points[k + 1], 0.5f * (points[k + 1] - before), 0.5f * (after - points[k])};
}

}  // namespace

Vec3f catmullRom(std::span<const Vec3f> points, float x) {
    assert(points.size() >= 2);
    const auto [segment, t] = localParameter(points.size() - 1, x);
    const Hermite h = hermiteSegment(points, segment);
    const float t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * h.start + (t3 - 2 * t2 + t) * h.startTangent + (3 * t2 - 2 * t3) * h.end +
           (t3 - t2) * h.endTangent;
}

float polylineLength(std::span<const Vec3f> points) {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    return static_cast<float>(length);
}

std::vector<PolylinePlace> evenPlaces(std::span<const Vec3f> points, std::size_t count) {
    assert(points.size() >= 2 && count >= 2);
    std::vector<double> arc(points.size(), 0);
    for (std::size_t i = 1; i < points.size(); ++i)
        arc[i] = arc[i - 1] + (points[i] - points[i - 1]).cast<double>().norm();
    std::vector<PolylinePlace> places;
    places.reserve(count);
    std::uint32_t segment = 0;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const double target = arc.back() * static_cast<double>(i) / static_cast<double>(count - 1);
        while (segment + 2 < points.size() && arc[segment + 1] < target) ++segment;
        const double length = arc[segment + 1] - arc[segment];
        const double t = length > 0 ? std::clamp((target - arc[segment]) / length, 0.0, 1.0) : 0;
        places.push_back({segment, static_cast<float>(t)});
    }
    places.push_back({static_cast<std::uint32_t>(points.size() - 2), 1});
    return places;
}

std::vector<Vec3f> resampleEvenly(std::span<const Vec3f> points, std::size_t count) {
    assert(!points.empty());
    if (points.size() == 1) return std::vector<Vec3f>(count, points.front());
    std::vector<Vec3f> result;
    result.reserve(count);
    for (const auto& [segment, t] : evenPlaces(points, count))
        result.push_back(points[segment] + t * (points[segment + 1] - points[segment]));
    result.back() = points.back();
    return result;
}

Quatf shortestArc(const Vec3f& from, const Vec3f& to) {
    // Melax, "The Shortest Arc Quaternion", Game Programming Gems 1, 2000. Near 180° the cross product
    // vanishes and √(2(1+cos)) loses its digits: there the half-way vector is built from the part of −to
    // across `from`.
    const float cosine = std::clamp(from.dot(to), -1.0f, 1.0f);
    constexpr float kNearlyOpposite = -0.99f;
    if (cosine > kNearlyOpposite) {
        const Vec3f axis = from.cross(to);
        const float s = std::sqrt((1 + cosine) * 2);
        return Quatf(s / 2, axis.x() / s, axis.y() / s, axis.z() / s).normalized();
    }
    // Turn half round an axis across `from`, then the small rest from −from to `to`.
    const Vec3f across = from.cross(to);
    constexpr float kExactlyOpposite = 1e-12f;
    Vec3f axis = across.squaredNorm() > kExactlyOpposite ? across.normalized() : from.unitOrthogonal();
    axis = (axis - axis.dot(from) * from).normalized();  // rounding tilts a short cross product
    const Quatf half(0, axis.x(), axis.y(), axis.z());
    return (shortestArc(-from, to) * half).normalized();
}

std::vector<Mat3f> parallelTransportFrames(std::span<const Vec3f> points, const Vec3f& firstNormal) {
    std::vector<Mat3f> frames(points.size(), Mat3f::Identity());
    if (points.size() < 2) return frames;
    // A point's tangent joins its neighbours; where they coincide, the one before serves.
    Vec3f tangent = Vec3f::UnitZ();
    for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i] != points[0]) {
            tangent = (points[i] - points[0]).normalized();
            break;
        }
    Vec3f normal = firstNormal;
    constexpr float kShort = 1e-12f;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f chord = points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1];
        const Vec3f next = chord.norm() > kShort ? chord.normalized().eval() : tangent;
        if (i > 0) normal = shortestArc(tangent, next) * normal;
        tangent = next;
        normal -= normal.dot(tangent) * tangent;
        normal = normal.norm() > kShort ? normal.normalized().eval() : tangent.unitOrthogonal().eval();
        frames[i].col(0) = normal;
        frames[i].col(1) = tangent.cross(normal);
        frames[i].col(2) = tangent;
    }
    return frames;
}

}  // namespace hairloom
