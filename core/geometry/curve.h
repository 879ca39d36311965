// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Curves through strand points: uniform Catmull-Rom (thesis Eq. 54 and 55), resampling, frames.

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace hairloom {

/// Position at x in [0, 1] over the whole curve of points.size() ≥ 2. End
/// segments repeat the end points. x = 1 is the last point (thesis erratum, Eq. 55).
Vec3f catmullRom(std::span<const Vec3f> points, float x);

/// Sum of the segment lengths, metres.
float polylineLength(std::span<const Vec3f> points);

/// A place on a polyline.
struct PolylinePlace {
    std::uint32_t segment;  ///< from points[segment] to the next
    float t;                ///< 0 … 1 of the way along it
};
/// `count` ≥ 2 places evenly spaced by arc length along a polyline of at least two points, end to end.
std::vector<PolylinePlace> evenPlaces(std::span<const Vec3f> points, std::size_t count);

/// `count` ≥ 2 points evenly spaced by arc length along the polyline; the ends are kept exactly.
std::vector<Vec3f> resampleEvenly(std::span<const Vec3f> points, std::size_t count);

/// The shortest rotation from unit vector `from` to unit vector `to`, stable at 180° (Melax 2000).
Quatf shortestArc(const Vec3f& from, const Vec3f& to);

/// Rotation-minimising frames along a polyline: columns are (normal, binormal, tangent), orthonormal,
/// right-handed. `firstNormal` is made perpendicular to the first tangent.
std::vector<Mat3f> parallelTransportFrames(std::span<const Vec3f> points, const Vec3f& firstNormal);

}  // namespace hairloom
