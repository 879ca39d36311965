// SPDX-License-Identifier: MIT
#include "hairloom/body_push.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace hairloom::runtime {
namespace {

constexpr std::size_t kPushedPerJob = 256;
/// Metres from the body at which hair stays that was authored no closer: skin bulges between distances.
constexpr float kKept = 0.0005f;
/// Metres of what a field that is interpolated is wrong at most: hair that rests is not moved.
constexpr float kPushSlack = 1e-5f;

/// Places of a uniform Catmull-Rom curve between p and p + 1: shares of the points p − 1 to p + 2, at ¼, ½
/// and ¾.
struct CubicPlace {
    float before, a, b, after;
};
constexpr std::array<CubicPlace, 3> kPlaces{{{-9.0f / 128, 111.0f / 128, 29.0f / 128, -3.0f / 128},
                                             {-1.0f / 16, 9.0f / 16, 9.0f / 16, -1.0f / 16},
                                             {-3.0f / 128, 29.0f / 128, 111.0f / 128, -9.0f / 128}}};

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
    /// Metres that each point is outside at least, as it was last seen.
    std::vector<float>& away;
};

BodyPush::BodyPush(std::shared_ptr<const BodyField> body, std::vector<std::uint32_t> offsets,
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

/// False where all of the hair is far from the body.
bool BodyPush::liftPoints(const PosedBody& body, Hair& hair) const {
    bool isNear = false;
    hair.away.assign(hair.points.size(), 0.0f);
    for (std::size_t p = 1; p < hair.points.size(); ++p) {
        Float3& point = hair.points[p];
        if (!isFinite(point)) continue;
        hair.away[p] = body.freeAround(point);
        if (hair.away[p] > kKept) continue;
        // What is deep is led out along the way that leads out there, which is another one higher up.
        constexpr int kRounds = 3;
        for (int round = 0; round < kRounds; ++round) {
            const PosedBody::Contact contact = body.at(point);
            if (!std::isfinite(contact.distance)) break;
            hair.away[p] = contact.distance;
            isNear = true;
            if (!(contact.distance < hair.least[p] - kPushSlack)) break;
            point = point + contact.normal_ws * (hair.least[p] - contact.distance);
            hair.away[p] = hair.least[p];
        }
    }
    return isNear;
}

/// False where nothing was to be moved.
bool BodyPush::liftCurve(const PosedBody& body, Hair& hair) const {
    bool lifted = false;
    for (std::size_t p = 0; p + 1 < hair.points.size(); ++p) {
        Float3 &a = hair.points[p], &b = hair.points[p + 1];
        const float length = runtime::length(b - a);
        // No place is farther from its ends than the ends from each other.
        if (!(std::min(p == 0 ? 0.0f : hair.away[p], hair.away[p + 1]) < length)) continue;
        for (std::size_t i = 0; i < kPlaces.size(); ++i) {
            const CubicPlace& place = kPlaces[i];
            // Roots stay, and what is next to them.
            if (p == 0 && place.b < place.a) continue;
            const Float3 at = placeOf(hair.points, p, place);
            if (!isFinite(at) || body.freeAround(at) > kKept) continue;
            const PosedBody::Contact contact = body.at(at);
            const float least = hair.leastBetween[kPlaces.size() * p + i];
            if (!(contact.distance < least - kPushSlack)) continue;
            const float share = p == 0 ? place.b : place.a + place.b;
            const Float3 lift = contact.normal_ws * ((least - contact.distance) / share);
            // Never farther than the points are from each other.
            const float size = runtime::length(lift);
            const Float3 moved = size > length ? lift * (length / size) : lift;
            if (p > 0) a = a + moved;
            b = b + moved;
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
        std::vector<float> away;
        for (std::size_t h = begin; h < end; ++h) {
            const std::size_t first = offsets_[h], count = offsets_[h + 1] - first;
            Hair hair{points_ws.subspan(first, count), std::span(least_).subspan(first, count),
                      std::span(leastBetween_).subspan(kPlaces.size() * first, kPlaces.size() * count), away};
            // What was led out may have drawn what is beside it in.
            constexpr int kRounds = 6;
            for (int round = 0; round < kRounds && liftPoints(body, hair) && liftCurve(body, hair); ++round) {
            }
        }
    };
    const std::size_t hairs = offsets_.empty() ? 0 : offsets_.size() - 1;
    if (host.parallelFor) {
        host.parallelFor(hairs, kPushedPerJob, std::cref(push));
    } else {
        push(0, hairs);
    }
}

}  // namespace hairloom::runtime
