// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/lay_along.h"

#include <algorithm>
#include <cmath>

#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

constexpr float kStep = 0.006f;          ///< metres of a path over the head
constexpr std::size_t kMostSteps = 200;  ///< 1.2 m: round every head
constexpr float kSteepestClimb = 0.7f;   ///< sine of the angle at which hair seeks its height
constexpr float kSteepestSink = 0.5f;
constexpr float kBeyond = 100;  ///< metres that a path goes on; longer than strands may be

/// Where the way from `a` to `b` is `length` from `centre`; `a` is nearer, `b` is not.
Vec3f crossing(const Vec3f& a, const Vec3f& b, const Vec3f& centre, float length) {
    const Vec3d d = (b - a).cast<double>(), f = (a - centre).cast<double>();
    const double square = d.squaredNorm(), half = f.dot(d);
    const double radius = static_cast<double>(length);
    const double inside = std::max(0.0, half * half - square * (f.squaredNorm() - radius * radius));
    const double t = square > 0 ? (std::sqrt(inside) - half) / square : 0;
    return (a.cast<double>() + std::clamp(t, 0.0, 1.0) * d).cast<float>();
}

}  // namespace

std::vector<Vec3f> pathOverHead(const SkinQuery& skin, const Vec3f& root, const Vec3f& goal, float height) {
    std::vector<Vec3f> path{root};
    Vec3f at = root, direction = skin.distanceAt(root).outward;
    float arc = 0;
    for (std::size_t i = 0; i < kMostSteps && (goal - at).norm() > 2 * kStep; ++i) {
        Vec3f wanted = (goal - at).normalized();
        const float near = std::min(height, arc);
        const SkinDistance sample = skin.distanceUpTo(at, height + 2 * kStep);
        if (sample.distance < height + 2 * kStep) {
            const Vec3f& n = sample.outward;
            const float climb = std::clamp((near - sample.distance) / kStep, -kSteepestSink, kSteepestClimb);
            if (const float rise = wanted.dot(n); rise < climb) {
                const Vec3f tangent =
                    unitOr(wanted - n * rise, unitOr(direction - n * direction.dot(n), n.unitOrthogonal()));
                wanted = tangent * std::sqrt(1 - climb * climb) + n * climb;
            }
        }
        direction = unitOr(direction + wanted, wanted);
        at += direction * kStep;
        arc += kStep;
        path.push_back(at);
    }
    path.push_back(goal);
    return path;
}

void layAlong(std::span<Vec3f> points, std::span<const float> lengths, std::vector<Vec3f> path) {
    const Vec3f end = path.back();
    path.push_back(end + kBeyond * unitOr(end - path[path.size() - 2], -Vec3f::UnitY()));
    std::size_t segment = 0;
    Vec3f from = path[0];  // on the path, the beginning of what is left of the segment
    for (std::size_t i = 1; i < points.size(); ++i) {
        const float length = lengths[i - 1];
        const Vec3f last = points[i - 1];
        while (segment + 2 < path.size() && !((path[segment + 1] - last).norm() >= length))
            from = path[++segment];
        from = crossing(from, path[segment + 1], last, length);
        points[i] = last + length * unitOr(from - last, -Vec3f::UnitY());
    }
}

}  // namespace hairloom
