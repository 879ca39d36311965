// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/near_sticks.h"

#include <algorithm>

#include "engine/in_parallel.h"
#include "models/alternatives/hair_spacing.h"

namespace hairloom::runtime {
namespace {

constexpr std::uint32_t kRoot = 0xffffffffu;
constexpr std::size_t kTipsPerJob = 256;
constexpr float kSearched = 2.0f;     // reaches around a tip
constexpr float kLeastReach = 1e-6f;  // metres

}  // namespace

Float3 nearestOnStick(Float3 inner, Float3 outer, Float3 point) {
    const Float3 along = outer - inner;
    const float squared = dot(along, along);
    const float share = squared > 0.0f ? std::clamp(dot(point - inner, along) / squared, 0.0f, 1.0f) : 0.0f;
    return inner + along * share;
}

void NearSticks::make(const StrandsView& strands, float reach) {
    reach_ = std::max(reach > 0.0f ? reach : spacingOf(strands), kLeastReach);
    search_ = kSearched * reach_;
    const std::size_t points = strands.restPositions_ss.size();
    rest_.assign(strands.restPositions_ss.begin(), strands.restPositions_ss.end());
    from_ws_.resize(points);
    velocities_ws_.resize(points);
    middles_ws_.resize(points);
    strands_.assign(points, kRoot);
    found_.assign(kMost * points, {});
    counts_.assign(points, 0);
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
    std::copy(positions_ws.begin(), positions_ws.end(), from_ws_.begin());
    std::copy(velocities_ws.begin(), velocities_ws.end(), velocities_ws_.begin());
    for (std::size_t p = 1; p < from_ws_.size(); ++p) middles_ws_[p] = (from_ws_[p - 1] + from_ws_[p]) * 0.5f;
    const auto counts = [&](std::size_t p) {
        return strands_[p] != kRoot && countsIn(middles_ws_[p], velocities_ws_[p]);
    };
    // A middle is at most half a stick from the place that is near.
    cells_.sort(middles_ws_, search_ + 0.5f * longest_, counts);
    inParallel(host, from_ws_.size(), kTipsPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            counts_[p] = 0;
            if (cells_.has(p)) findOf(static_cast<std::uint32_t>(p));
        }
    });
}

void NearSticks::findOf(std::uint32_t stick) {
    const Float3 tip = from_ws_[stick], restTip = rest_[stick];
    const float widest = search_ + 0.5f * longest_;
    std::array<float, kMost> distances{};
    Near* const found = &found_[kMost * stick];
    std::size_t count = 0;
    cells_.around(tip, [&](std::uint32_t other) {
        if (strands_[other] == strands_[stick]) return;
        const Float3 away = middles_ws_[other] - tip;
        if (dot(away, away) > widest * widest) return;
        const float distance = length(nearestOnStick(from_ws_[other - 1], from_ws_[other], tip) - tip);
        if (distance > search_) return;
        const auto before = [&](std::size_t i) {
            return distances[i] < distance || (distances[i] == distance && found[i].stick < other);
        };
        if (count == kMost && before(count - 1)) return;
        const float apart = length(nearestOnStick(rest_[other - 1], rest_[other], restTip) - restTip);
        const float reach = std::min(reach_, apart);
        if (!(reach > kLeastReach)) return;
        std::size_t place = count < kMost ? count++ : kMost - 1;
        for (; place > 0 && !before(place - 1); --place) {
            distances[place] = distances[place - 1];
            found[place] = found[place - 1];
        }
        distances[place] = distance;
        found[place] = {other, reach};
    });
    counts_[stick] = static_cast<std::uint32_t>(count);
}

Float3 NearSticks::nearest(std::uint32_t stick, Float3 tip_ws, float seconds) const {
    return nearestOnStick(from_ws_[stick - 1] + velocities_ws_[stick - 1] * seconds,
                          from_ws_[stick] + velocities_ws_[stick] * seconds, tip_ws);
}

}  // namespace hairloom::runtime
