// SPDX-License-Identifier: MIT
#include "hairloom/body_push.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/body_free.h"
#include "engine/in_parallel.h"
#include "shaders/push_types.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kPushedPerJob = 256;
constexpr auto kKept = static_cast<float>(HAIRLOOM_PUSH_KEPT);
constexpr auto kPushSlack = static_cast<float>(HAIRLOOM_PUSH_SLACK);
/// Metres within which a body is looked up at once: there is no free space around.
constexpr float kBeside = 0.006f;
constexpr float kNothingKnown = std::numeric_limits<float>::infinity();

/// Places of a uniform Catmull-Rom curve between p and p + 1: shares of the points p − 1 to p + 2, at ¼, ½
/// and ¾.
struct CubicPlace {
    float before, a, b, after;
};
constexpr std::array<CubicPlace, 3> kPlaces{{{-9.0f / 128, 111.0f / 128, 29.0f / 128, -3.0f / 128},
                                             {-1.0f / 16, 9.0f / 16, 9.0f / 16, -1.0f / 16},
                                             {-3.0f / 128, 29.0f / 128, 111.0f / 128, -9.0f / 128}}};

constexpr auto kBow = static_cast<float>(HAIRLOOM_PUSH_BOW);  // 2 · 9/128

/// Missing neighbours repeat the end points.
Float3 placeOf(std::span<const Float3> hair, std::size_t p, const CubicPlace& place) {
    const Float3 a = hair[p], b = hair[p + 1];
    const Float3 before = p > 0 ? hair[p - 1] : a, after = p + 2 < hair.size() ? hair[p + 2] : b;
    return before * place.before + a * place.a + b * place.b + after * place.after;
}

}  // namespace

struct BodyPush::Hair {
    std::span<Float3> points;
    std::span<const float> least, leastBetween;
    /// What is known of a hair's points, in memory that hairs share.
    struct Known {
        Vector<float> free;  ///< metres that the body is away from each for certain
        Vector<float> near;  ///< and at most
        /// Moments: when each point has moved, when it was looked at, and when the way to the next one was.
        Vector<std::uint32_t> moved, looked, checked;
    };
    Known& known;
    std::uint32_t moment = 1;

    void start() {
        known.free.assign(points.size(), 0.0f);
        known.near.assign(points.size(), kNothingKnown);
        known.moved.assign(points.size(), moment);
        known.looked.assign(points.size(), 0);
        known.checked.assign(points.size(), 0);
    }
    void move(std::size_t p, Float3 way) {
        points[p] = points[p] + way;
        const float size = length(way);
        known.free[p] -= size;
        known.near[p] += size;
        known.moved[p] = ++moment;
    }
    /// Whether the curve from p on is another one than when it was last looked at.
    bool isNew(std::size_t p) const {
        const std::size_t last = std::min(p + 3, points.size());
        return *std::max_element(known.moved.begin() + static_cast<std::ptrdiff_t>(p > 0 ? p - 1 : 0),
                                 known.moved.begin() + static_cast<std::ptrdiff_t>(last)) > known.checked[p];
    }
};

BodyPush::BodyPush(std::shared_ptr<const BodyField> body, Vector<std::uint32_t> offsets,
                   std::span<const Float3> rest_ss)
    : body_(std::move(body)),
      offsets_(std::move(offsets)),
      least_(rest_ss.size(), kKept),
      leastBetween_(kPlaces.size() * rest_ss.size(), kKept) {
    const auto depthAt = [&](Float3 at) {
        return body_->freeAround(at) > kKept ? kKept : std::min(body_->at(at).distance, kKept);
    };
    for (std::size_t h = 0; h + 1 < offsets_.size(); ++h) {
        const auto hair = rest_ss.subspan(offsets_[h], offsets_[h + 1] - offsets_[h]);
        for (std::size_t p = 0; p < hair.size(); ++p) {
            least_[offsets_[h] + p] = depthAt(hair[p]);
            for (std::size_t i = 0; i < kPlaces.size() && p + 1 < hair.size(); ++i)
                leastBetween_[kPlaces.size() * (offsets_[h] + p) + i] = depthAt(placeOf(hair, p, kPlaces[i]));
        }
    }
}

/// Points that have not moved since they were looked at are
/// as they were, and what is surely free around one is free for the next.
void BodyPush::liftPoints(const PosedBody& body, Hair& hair) const {
    Hair::Known& known = hair.known;
    Float3 last{};
    float free = 0.0f, near = kNothingKnown;
    for (std::size_t p = 1; p < hair.points.size(); ++p) {
        if (known.moved[p] <= known.looked[p]) continue;
        known.looked[p] = hair.moment;
        const Float3 point = hair.points[p];
        if (!isFinite(point)) continue;
        known.free[p] = free - length(point - last);
        known.near[p] = kNothingKnown;
        if (known.free[p] > kKept) continue;
        const bool isBeside = near + length(point - last) < kBeside;
        last = point;
        near = kNothingKnown;
        if (!isBeside) {
            known.free[p] = free = body.freeAround(point);
            if (free > kKept) continue;
        }
        // What is deep is led out along the way that leads out there, which is another one higher up.
        constexpr int kRounds = HAIRLOOM_PUSH_POINT_ROUNDS;
        for (int round = 0; round < kRounds; ++round) {
            const PosedBody::Contact contact = body.at(hair.points[p]);
            if (!std::isfinite(contact.distance)) break;
            known.looked[p] = hair.moment;
            last = hair.points[p];
            known.near[p] = near = std::abs(contact.distance);
            known.free[p] = free = std::max(surelyFree(contact.distance, body.cell()), 0.0f);
            if (!(contact.distance < hair.least[p] - kPushSlack)) break;
            hair.move(p, contact.normal_ws * (hair.least[p] - contact.distance));
        }
    }
}

/// False where nothing was to be moved.
bool BodyPush::liftCurve(const PosedBody& body, Hair& hair) const {
    Hair::Known& known = hair.known;
    bool lifted = false;
    for (std::size_t p = 0; p + 1 < hair.points.size(); ++p) {
        if (!hair.isNew(p)) continue;
        known.checked[p] = hair.moment;
        Float3 &a = hair.points[p], &b = hair.points[p + 1];
        const float length = runtime::length(b - a);
        // No place of the curve is farther from both ends together.
        const float beside = (p > 0 ? runtime::length(a - hair.points[p - 1]) : 0.0f) +
                             (p + 2 < hair.points.size() ? runtime::length(b - hair.points[p + 2]) : 0.0f);
        if (known.free[p] + known.free[p + 1] > 1.001f * (length + kBow * beside) + 2 * kKept) continue;
        for (std::size_t i = 0; i < kPlaces.size(); ++i) {
            const CubicPlace& place = kPlaces[i];
            // Roots stay, and what is next to them.
            if (p == 0 && place.b < place.a) continue;
            const Float3 at = placeOf(hair.points, p, place);
            if (!isFinite(at)) continue;
            const float fromA = runtime::length(at - a), fromB = runtime::length(at - b);
            if (std::max(known.free[p] - fromA, known.free[p + 1] - fromB) > kKept) continue;
            const bool isBeside = std::min(known.near[p] + fromA, known.near[p + 1] + fromB) < kBeside;
            if (!isBeside && body.freeAround(at) > kKept) continue;
            const PosedBody::Contact contact = body.at(at);
            const float least = hair.leastBetween[kPlaces.size() * p + i];
            if (!(contact.distance < least - kPushSlack)) continue;
            const float share = p == 0 ? place.b : place.a + place.b;
            const Float3 lift = contact.normal_ws * ((least - contact.distance) / share);
            // Never farther than the points are from each other.
            const float size = runtime::length(lift);
            const Float3 moved = size > length ? lift * (length / size) : lift;
            if (p > 0) hair.move(p, moved);
            hair.move(p + 1, moved);
            lifted = true;
        }
    }
    return lifted;
}

void BodyPush::apply(std::span<const BonePose> pose, std::span<Float3> points_ws, const Host& host) const {
    if (pose.empty() || points_ws.size() != least_.size()) return;
    if (pose.size() != 1 && pose.size() != body_->bones.size()) return;
    const PosedBody body(*body_, pose);
    const auto push = [&](std::size_t begin, std::size_t end) {
        Hair::Known known;
        for (std::size_t h = begin; h < end; ++h) {
            const std::size_t first = offsets_[h], count = offsets_[h + 1] - first;
            Hair hair{points_ws.subspan(first, count), std::span(least_).subspan(first, count),
                      std::span(leastBetween_).subspan(kPlaces.size() * first, kPlaces.size() * count),
                      known};
            hair.start();
            // What was led out may have drawn what is beside it in.
            constexpr int kRounds = HAIRLOOM_PUSH_ROUNDS;
            for (int round = 0; round < kRounds; ++round) {
                liftPoints(body, hair);
                if (!liftCurve(body, hair)) break;
            }
        }
    };
    const std::size_t hairs = offsets_.empty() ? 0 : offsets_.size() - 1;
    inParallel(host, hairs, kPushedPerJob, push);
}

}  // namespace hairloom::runtime
