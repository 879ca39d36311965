// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/length_constraint.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/geometry/curve.h"

namespace hairloom {
namespace {

constexpr float kNoDirection = 1e-9f;  ///< metres; shorter differences point nowhere
constexpr int kSettlings = 6;          ///< turns that the skin makes are spread so often
constexpr int kTurns = 6;              ///< towards the offset surface, which one reaches where it is flat
constexpr int kHalvings = 10;          ///< of the turn towards the normal
constexpr float kMostTurn = 28 * kPi / 180;  ///< of a bend from a segment to the next
const float kMostTurnCosine = std::cos(kMostTurn);
constexpr float kSlackOfTurn = 1e-4f;  ///< of a cosine
constexpr float kSlack = 1e-5f;        ///< metres by which a clearance may be missed

Vec3f directionOr(const Vec3f& difference, const Vec3f& fallback) {
    const float norm = difference.norm();
    return norm > kNoDirection ? Vec3f(difference / norm) : fallback;
}

/// The way that segments lead: where one is too short to point anywhere, that of the last which did.
class Lead {
  public:
    explicit Lead(std::span<const Vec3f> points) { follow(points[1] - points[0]); }
    void follow(const Vec3f& segment) {
        const float norm = segment.norm();
        if (!(norm > kNoDirection)) return;
        segment_ = segment;
        norm_ = norm;
    }
    Vec3f direction() const { return segment_ / norm_; }
    Vec3f over(float length) const { return segment_ * (length / norm_); }

  private:
    Vec3f segment_ = Vec3f::UnitY();
    float norm_ = 1;
};

/// Leads a strand of given lengths along points that were moved: by the direction of each segment, and
/// towards what it has fallen behind.
class Follow {
  public:
    explicit Follow(std::span<const Vec3f> points) : lead_(points) {}
    /// The unit vector along which a segment of `length` goes on, for points that are `segment` apart.
    Vec3f direction(const Vec3f& segment, float length) {
        lead_.follow(segment);
        along_ = lead_.direction();
        const float longer = segment.norm() - length;
        // What is drawn together gives back what was fallen behind along the way, and no more.
        const float given = longer > 0 ? longer : -std::min(-longer, std::max(0.0f, behind_.dot(along_)));
        behind_ += given * along_;
        const Vec3f ahead = behind_ - std::min(0.0f, behind_.dot(along_)) * along_;
        return directionOr(along_ * length + ahead, along_);
    }
    /// Where that segment went in truth.
    void went(const Vec3f& direction, float length) { behind_ -= length * (direction - along_); }

  private:
    Lead lead_;
    Vec3f along_ = Vec3f::UnitY();
    Vec3f behind_ = Vec3f::Zero();  ///< metres, from where the strand is to where it was wanted
};

/// Radians; 0 where one has no length.
float angleBetween(const Vec3f& a, const Vec3f& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The unit vector `to`, or where that is farther from the unit vector `from`, what lies `maximum` radians on
/// the way to it.
Vec3f turnedAtMost(const Vec3f& from, const Vec3f& to, float maximum) {
    const float angle = angleBetween(from, to);
    if (!(angle > maximum)) return to;
    const Quatf whole = shortestArc(from, to);
    return (Quatf::Identity().slerp(maximum / angle, whole) * from).normalized();
}

/// Directions of segments that must not turn by more than their limits.
class LimitedTurns {
  public:
    LimitedTurns(std::span<const Vec3f> points, std::span<const float> limits, std::size_t first)
        : limits_(limits), first_(first), directions_(points.size(), Vec3f::Zero()) {
        Lead lead(points);
        for (std::size_t i = 1; i < points.size(); ++i) {
            lead.follow(points[i] - points[i - 1]);
            directions_[i] = lead.direction();
        }
    }
    /// Root to tip: a segment that turns too far turns as far as it may. True when one did.
    bool spreadToTip() {
        bool spread = false;
        for (std::size_t i = std::max<std::size_t>(first_, 2); i < directions_.size(); ++i)
            spread |= limit(i - 1, directions_[i - 1], directions_[i]);
        return spread;
    }
    /// Tip to root: hair begins to turn earlier instead.
    bool spreadToRoot() {
        bool spread = false;
        for (std::size_t i = directions_.size() - 1; i > first_; --i)
            spread |= limit(i - 1, directions_[i], directions_[i - 1]);
        return spread;
    }
    void lay(std::span<Vec3f> points, std::span<const float> lengths) const {
        for (std::size_t i = first_; i < points.size(); ++i)
            points[i] = points[i - 1] + directions_[i] * lengths[i - 1];
    }

  private:
    bool limit(std::size_t point, const Vec3f& from, Vec3f& to) const {
        const Vec3f turned = turnedAsMay(from, to, limits_[point]);
        if (turned == to) return false;
        to = turned;
        return true;
    }

    std::span<const float> limits_;
    std::size_t first_;
    std::vector<Vec3f> directions_;  ///< of the segments that end at the points
};

float clearanceAt(float arcLength, float clearance) {
    return std::min(clearance, 0.5f * arcLength);
}

/// The unit vector `direction` turned towards `outward` by the least angle after which a segment ends `rise`
/// of its lengths farther along the latter; `outward` where it is too short for that.
Vec3f turnedOut(const Vec3f& direction, const Vec3f& outward, float rise) {
    const float along = direction.dot(outward);
    const float wanted = along + rise;
    const Vec3f across = direction - outward * along;
    const float norm = across.norm();
    if (!(wanted < 1)) return outward.normalized();
    // What leads straight into the skin goes on along it, any way, rather than back.
    if (!(norm > kNoDirection))
        return (outward * wanted + outward.unitOrthogonal() * std::sqrt(std::max(0.0f, 1 - wanted * wanted)))
            .normalized();
    // Close to the skin the way out is rounded to a length that is not quite 1.
    return (outward * wanted + across * (std::sqrt(std::max(0.0f, 1 - wanted * wanted)) / norm)).normalized();
}

/// The end of a segment that turning has not led out of the skin: halfway between `turned` (unit vector) and
/// the normal at `from`, which leads out most directly, as near to the former as keeps the clearance.
Vec3f placeTowardsNormal(const SkinQuery& skin, const Vec3f& from, const Vec3f& turned, float length,
                         float clearance) {
    const Vec3f outward = skin.distanceAt(from).outward;
    float inside = 0;
    float outside = 1;
    const auto endAt = [&](float t) -> Vec3f {
        return from + directionOr(turned * (1 - t) + outward * t, outward) * length;
    };
    for (int i = 0; i < kHalvings; ++i) {
        const float t = 0.5f * (inside + outside);
        (skin.distanceUpTo(endAt(t), clearance - kSlack).distance < clearance - kSlack ? inside : outside) =
            t;
    }
    return endAt(outside);
}

/// placeOutside() for a segment whose end has been measured: too near.
Vec3f placeOutsideFrom(SkinDistance sample, const SkinQuery& skin, const Vec3f& from, const Vec3f& direction,
                       float length, float clearance) {
    Vec3f turned = direction;
    for (int i = 0; i < kTurns; ++i) {
        turned = turnedOut(turned, sample.outward, (clearance - sample.distance) / length);
        const Vec3f end = from + turned * length;
        sample = skin.distanceUpTo(end, clearance - kSlack);
        if (!(sample.distance < clearance - kSlack)) return end;
    }
    return placeTowardsNormal(skin, from, turned, length, clearance);
}

}  // namespace

void measureSegments(std::span<const Vec3f> points, std::vector<float>& lengths) {
    lengths.resize(points.empty() ? 0 : points.size() - 1);
    for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = (points[i + 1] - points[i]).norm();
}

void restoreLengths(std::span<Vec3f> points, std::span<const float> lengths, bool keepFirst) {
    assert(points.size() >= 2 && lengths.size() + 1 == points.size());
    Follow follow(points);
    Vec3f before = points[keepFirst ? 1 : 0];
    for (std::size_t i = keepFirst ? 2 : 1; i < points.size(); ++i) {
        const float length = lengths[i - 1];
        const Vec3f direction = follow.direction(points[i] - before, length);
        before = points[i];
        points[i] = points[i - 1] + direction * length;
        follow.went(direction, length);
    }
}

void restoreLengthsByDirection(std::span<Vec3f> points, std::span<const float> lengths) {
    assert(points.size() >= 2 && lengths.size() + 1 == points.size());
    Lead lead(points);
    Vec3f before = points[0];
    for (std::size_t i = 1; i < points.size(); ++i) {
        lead.follow(points[i] - before);
        before = points[i];
        points[i] = points[i - 1] + lead.over(lengths[i - 1]);
    }
}

Vec3f placeOutside(const SkinQuery& skin, const Vec3f& from, const Vec3f& direction, float length,
                   float clearance) {
    const Vec3f end = from + direction * length;
    const SkinDistance sample = skin.distanceUpTo(end, clearance - kSlack);
    if (!(sample.distance < clearance - kSlack)) return end;
    return placeOutsideFrom(sample, skin, from, direction, length, clearance);
}

bool keepOutside(std::span<Vec3f> points, std::span<const float> lengths, const SkinQuery& skin,
                 float clearance, std::size_t first) {
    assert(points.size() >= 2 && lengths.size() + 1 == points.size() && first >= 1);
    Lead lead(points);
    float arc =
        std::accumulate(lengths.begin(), lengths.begin() + static_cast<std::ptrdiff_t>(first - 1), 0.0f);
    float known = 0;  // distance from the skin, at least
    bool moved = false;
    Vec3f before = points[first - 1];  // as it was, of the point that was placed last
    // Segments keep their own directions. What leads steeply into the skin would flip there to where it came
    // from: it turns from the last segment by no more than it did, or than a bend.
    Vec3f led =
        first >= 2 ? directionOr(points[first - 1] - points[first - 2], Vec3f::Zero()) : Vec3f(Vec3f::Zero());
    Vec3f ledBefore = led;
    for (std::size_t i = first; i < points.size(); ++i) {
        const float length = lengths[i - 1];
        arc += length;
        lead.follow(points[i] - before);
        before = points[i];
        const Vec3f own = lead.direction();
        Vec3f direction = own;
        if (moved) {
            direction = turnedAtMost(led, own, std::max(kMostTurn, angleBetween(ledBefore, own)));
            points[i] = points[i - 1] + direction * length;
        }
        ledBefore = own;
        led = direction;
        // Over a way of length w the distance changes by w at most.
        known -= length;
        const float wanted = clearanceAt(arc, clearance);
        if (known > wanted) continue;
        const SkinDistance sample = skin.distanceUpTo(points[i], wanted);
        known = sample.distance;
        if (!(known < wanted - kSlack)) continue;
        points[i] = placeOutsideFrom(sample, skin, points[i - 1], direction, length, wanted);
        led = directionOr(points[i] - points[i - 1], direction);
        known = 0;
        moved = true;
    }
    return moved;
}

void measureTurns(std::span<const Vec3f> points, std::vector<float>& turns) {
    turns.assign(points.size(), 1.0f);
    if (points.size() < 3) return;
    Lead lead(points);
    Vec3f last = lead.direction();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        lead.follow(points[i + 1] - points[i]);
        const Vec3f next = lead.direction();
        turns[i] = last.dot(next);
        last = next;
    }
}

Vec3f turnedAsMay(const Vec3f& last, const Vec3f& wanted, float turn) {
    const float least = std::min(kMostTurnCosine, turn);
    if (!(last.dot(wanted) < least - kSlackOfTurn)) return wanted;
    return turnedAtMost(last, wanted, std::acos(std::max(-1.0f, least)));
}

void settle(std::span<Vec3f> points, std::span<const float> lengths, std::span<const float> turns,
            const SkinQuery* skin, float clearance, std::size_t first) {
    assert(points.size() == turns.size() && lengths.size() + 1 == points.size() && first >= 1);
    LimitedTurns wanted(points, turns, first);
    if (wanted.spreadToTip()) wanted.lay(points, lengths);
    if (!skin) return;
    for (int i = 0; keepOutside(points, lengths, *skin, clearance, first) && i < kSettlings; ++i) {
        LimitedTurns pushed(points, turns, first);
        if (!pushed.spreadToRoot()) return;
        pushed.spreadToTip();
        pushed.lay(points, lengths);
    }
}

}  // namespace hairloom
