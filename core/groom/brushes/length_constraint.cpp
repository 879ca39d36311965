// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/brushes/length_constraint.h"

#include <algorithm>
#include <cassert>

namespace hairloom {
namespace {

constexpr float kNoDirection = 1e-9f;  ///< metres; shorter differences point nowhere
constexpr int kSlides = 6;             ///< alternating projections onto sphere and offset surface
constexpr int kHalvings = 10;          ///< of the turn towards the normal
constexpr float kSlack = 1e-5f;        ///< metres by which a clearance may be missed

Vec3f directionOr(const Vec3f& difference, const Vec3f& fallback) {
    const float norm = difference.norm();
    return norm > kNoDirection ? Vec3f(difference / norm) : fallback;
}

Vec3f firstDirection(std::span<const Vec3f> points) {
    return directionOr(points[1] - points[0], Vec3f::UnitY());
}

float clearanceAt(float arcLength, float clearance) {
    return std::min(clearance, 0.5f * arcLength);
}

/// A point's distance from the skin, from queries only where an earlier one does not already tell enough:
/// over a way of length w the distance changes by w at most.
class Watch {
  public:
    explicit Watch(const SkinQuery& skin) : skin_(skin) {}
    bool tooNear(const Vec3f& point, float way, float clearance) {
        known_ -= way;
        if (known_ > clearance) return false;
        known_ = skin_.distanceUpTo(point, clearance);
        return known_ < clearance - kSlack;
    }
    void forget() { known_ = 0; }

  private:
    const SkinQuery& skin_;
    float known_ = 0;
};

}  // namespace

void measureSegments(std::span<const Vec3f> points, std::vector<float>& lengths) {
    lengths.resize(points.empty() ? 0 : points.size() - 1);
    for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = (points[i + 1] - points[i]).norm();
}

void restoreLengths(std::span<Vec3f> points, std::span<const float> lengths, bool keepFirst) {
    assert(points.size() >= 2 && lengths.size() + 1 == points.size());
    Vec3f direction = firstDirection(points);
    for (std::size_t i = keepFirst ? 2 : 1; i < points.size(); ++i) {
        direction = directionOr(points[i] - points[i - 1], direction);
        points[i] = points[i - 1] + direction * lengths[i - 1];
    }
}

void restoreLengthsByDirection(std::span<Vec3f> points, std::span<const float> lengths) {
    assert(points.size() >= 2 && lengths.size() + 1 == points.size());
    Vec3f direction = firstDirection(points);
    Vec3f before = points[0];
    for (std::size_t i = 1; i < points.size(); ++i) {
        direction = directionOr(points[i] - before, direction);
        before = points[i];
        points[i] = points[i - 1] + direction * lengths[i - 1];
    }
}

Vec3f placeOutside(const SkinQuery& skin, const Vec3f& from, const Vec3f& direction, float length,
                   float clearance) {
    Vec3f turned = direction;
    for (int i = 0; i < kSlides; ++i) {
        Vec3f end = from + turned * length;
        const SkinDistance sample = skin.distanceAt(end);
        if (sample.distance >= clearance - kSlack) return end;
        turned = directionOr(end + sample.outward * (clearance - sample.distance) - from, sample.outward);
    }
    // Sliding stalls where the offset surface lies beyond the segment's reach; the normal leads out most
    // directly.
    const Vec3f outward = skin.distanceAt(from).outward;
    float inside = 0;
    float outside = 1;
    for (int i = 0; i < kHalvings; ++i) {
        const float t = 0.5f * (inside + outside);
        const Vec3f end = from + directionOr(turned * (1 - t) + outward * t, outward) * length;
        (skin.distanceAt(end).distance < clearance - kSlack ? inside : outside) = t;
    }
    return from + directionOr(turned * (1 - outside) + outward * outside, outward) * length;
}

bool keepOutside(std::span<Vec3f> points, std::span<const float> lengths, const SkinQuery& skin,
                 float clearance, std::size_t first) {
    assert(points.size() >= 2 && lengths.size() + 1 == points.size() && first >= 1);
    Watch watch(skin);
    Vec3f direction = firstDirection(points);
    float arc = 0;
    bool moved = false;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const float length = lengths[i - 1];
        arc += length;
        if (i < first) continue;
        if (moved) {
            direction = directionOr(points[i] - points[i - 1], direction);
            points[i] = points[i - 1] + direction * length;
        }
        const float wanted = clearanceAt(arc, clearance);
        if (!watch.tooNear(points[i], length, wanted)) continue;
        direction = directionOr(points[i] - points[i - 1], direction);
        points[i] = placeOutside(skin, points[i - 1], direction, length, wanted);
        watch.forget();
        moved = true;
    }
    return moved;
}

}  // namespace hairloom
