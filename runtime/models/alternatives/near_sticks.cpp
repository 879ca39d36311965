// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/near_sticks.h"

#include <algorithm>

#include "engine/in_parallel.h"
#include "models/alternatives/hair_spacing.h"

namespace hairloom::runtime {
namespace {

constexpr std::uint32_t kNoStick = 0xffffffffu;
constexpr std::size_t kTipsPerJob = 256;
constexpr float kLeastReach = 1e-6f;  // metres

Float3 noLongerThan(Float3 v, float limit) {
    const float size = length(v);
    return size > limit ? v * (limit / size) : v;
}

}  // namespace

float nearestOnStick(Float3 inner, Float3 outer, Float3 point) {
    const Float3 along = outer - inner;
    const float squared = dot(along, along);
    return squared > 0.0f ? std::clamp(dot(point - inner, along) / squared, 0.0f, 1.0f) : 0.0f;
}

void NearSticks::make(const StrandsView& strands, float reach) {
    reach_ = std::max(reach > 0.0f ? reach : spacingOf(strands), kLeastReach);
    const std::size_t points = strands.restPositions_ss.size();
    rest_.assign(strands.restPositions_ss.begin(), strands.restPositions_ss.end());
    middles_ws_.resize(points);
    strands_.assign(points, kNoStick);
    away_.assign(points, {});
    longest_ = 0.0f;
    for (std::uint32_t s = 0; s + 1 < strands.offsets.size(); ++s) {
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            strands_[p] = s;
            longest_ = std::max(longest_, length(rest_[p] - rest_[p - 1]));
        }
    }
}

void NearSticks::find(std::span<const Float3> positions_ws, std::span<const Float3> velocities_ws,
                      const Host& host) {
    positions_ws_.assign(positions_ws.begin(), positions_ws.end());
    velocities_ws_.assign(velocities_ws.begin(), velocities_ws.end());
    for (std::size_t p = 1; p < positions_ws_.size(); ++p)
        middles_ws_[p] = (positions_ws_[p - 1] + positions_ws_[p]) * 0.5f;
    const auto counts = [&](std::size_t p) {
        return strands_[p] != kNoStick && countsIn(middles_ws_[p], velocities_ws_[p]);
    };
    // A middle is at most half a stick from the place that is near.
    cells_.sort(middles_ws_, reach_ + 0.5f * longest_, counts);
    inParallel(host, positions_ws_.size(), kTipsPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            away_[p] = cells_.has(p) ? findOf(static_cast<std::uint32_t>(p)) : Away();
    });
}

NearSticks::Away NearSticks::findOf(std::uint32_t stick) const {
    const Float3 tip = positions_ws_[stick];
    const float widest = reach_ + 0.5f * longest_;
    Away away;
    float mostPush = 0.0f, mostBrake = 0.0f;
    cells_.around(tip, [&](std::uint32_t other) {
        const Float3 toMiddle = middles_ws_[other] - tip;
        if (strands_[other] == strands_[stick] || dot(toMiddle, toMiddle) > widest * widest) return;
        const Float3 inner = positions_ws_[other - 1], outer = positions_ws_[other];
        const float share = nearestOnStick(inner, outer, tip);
        const Float3 apart = tip - (inner + (outer - inner) * share);
        const float distance = length(apart);
        if (!(distance < reach_)) return;
        const Float3 restInner = rest_[other - 1], restOuter = rest_[other];
        const float restShare = nearestOnStick(restInner, restOuter, rest_[stick]);
        const Float3 restApart = rest_[stick] - (restInner + (restOuter - restInner) * restShare);
        const float restDistance = length(restApart);
        const float reach = std::min(reach_, restDistance);
        if (!(distance < reach) || !(reach > kLeastReach)) return;
        // At one place the authored shape says which is on which side.
        const Float3 direction =
            distance > kLeastReach ? apart * (1.0f / distance) : restApart * (1.0f / restDistance);
        const float push = 0.5f * (reach - distance);
        const Float3 speed =
            velocities_ws_[other - 1] + (velocities_ws_[other] - velocities_ws_[other - 1]) * share;
        const float brake = 0.5f * std::max(-dot(velocities_ws_[stick] - speed, direction), 0.0f);
        away.push = away.push + direction * push;
        away.brake = away.brake + direction * brake;
        mostPush = std::max(mostPush, push);
        mostBrake = std::max(mostBrake, brake);
    });
    return {noLongerThan(away.push, mostPush), noLongerThan(away.brake, mostBrake)};
}

}  // namespace hairloom::runtime
