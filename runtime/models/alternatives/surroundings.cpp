// SPDX-License-Identifier: MIT
#include "models/alternatives/surroundings.h"

#include <cmath>
#include <numbers>

#include "engine/checks.h"
#include "hairloom/alternatives/moving_spheres.h"
#include "hairloom/capsules.h"

namespace hairloom::runtime {
namespace {

/// m/s at a place in the world.
Float3 airAt(const Wind& wind, const std::array<float, kWindModes>& phases, Float3 position_ws) {
    Float3 sum = wind.mean;
    for (std::size_t m = 0; m < kWindModes; ++m) {
        const float turns = dot(position_ws, wind.modes[m].waveVector) + phases[m];
        sum = sum + wind.modes[m].amplitude * std::sin(2.0f * std::numbers::pi_v<float> * turns);
    }
    return sum;
}

double timeOf(const FrameInput& input) {
    return std::abs(input.time) <= kLongestTime ? input.time : 0.0;
}

}  // namespace

Float3 bounded(Float3 v, float limit) {
    const float size = length(v);
    if (size <= limit) return v;
    return std::isfinite(size) ? v * (limit / size) : Float3{};
}

Float3 rotationVector(Quat q) {
    if (q.w < 0.0f) q = {-q.x, -q.y, -q.z, -q.w};
    const Float3 v{q.x, q.y, q.z};
    const float sine = length(v);
    return sine > 1e-12f ? v * (2.0f * std::atan2(sine, q.w) / sine) : v * 2.0f;
}

std::vector<RootFrame> rootsAtRest(const StrandsView& strands) {
    std::vector<RootFrame> roots(strands.offsets.size() - 1);
    for (std::size_t s = 0; s < roots.size(); ++s) {
        roots[s].position = strands.restPositions_ss[strands.offsets[s]];
        if (!strands.rootRotations_ss.empty()) roots[s].rotation = strands.rootRotations_ss[s];
        normalize(roots[s].rotation);
    }
    return roots;
}

double rodStiffness(const SimulationSettings& settings, float along, float ofStrand) {
    if (!(ofStrand > 0.0f)) return 0.0;
    const float authored = settings.angularStiffness * settings.angularCurve.at(along);
    return kHairBendingStiffness * static_cast<double>(ofStrand) * static_cast<double>(authored) /
           (1.0 - static_cast<double>(authored));
}

WindyFrame::WindyFrame(const Wind& wind, const FrameInput& frameInput)
    : input(frameInput),
      windFrom(windPhases(wind, timeOf(input) - static_cast<double>(input.dt))),
      windTo(windPhases(wind, timeOf(input))) {}

RootPath::RootPath(RootFrame& now, Float3& velocity, const RootFrame& wanted, float dt,
                   float teleportDistance)
    : from(now), to(wanted) {
    if (!usableWithin(to, kFarthest)) to = from;
    if (length(to.position - from.position) > teleportDistance) {
        jumps = true;
        turn = to.rotation * conjugate(from.rotation);
        velocity = rotate(turn, velocity);
        from = to;
    } else {
        const Float3 faster = bounded((to.position - from.position) * (1.0f / dt), kFastest);
        acceleration = bounded((faster - velocity) * (1.0f / dt), kLargestAcceleration);
        velocity = faster;
    }
    now = to;
}

AirPath::AirPath(const Wind& wind, const WindyFrame& frame, const RootPath& path, Float3 tip)
    : rootFrom(airAt(wind, frame.windFrom, path.from.position)),
      rootTo(airAt(wind, frame.windTo, path.to.position)),
      tipFrom(airAt(wind, frame.windFrom, path.from.position + tip)),
      tipTo(airAt(wind, frame.windTo, path.to.position + tip)) {}

void MovingSpheres::take(const FrameInput& input, float teleportDistance) {
    moving_.clear();
    now_.assign(input.spheres.begin(), input.spheres.end());
    motions_.assign(now_.size(), Float3{});
    for (std::size_t i = 0; i < now_.size(); ++i) {
        Sphere& now = now_[i];
        if (!isFinite(now.center_ws) || !std::isfinite(now.radius)) now = {};
        if (!(now.radius > 0.0f)) continue;
        if (i < last_.size() && last_[i].radius > 0.0f) {
            const Float3 motion = now.center_ws - last_[i].center_ws;
            if (length(motion) <= teleportDistance) motions_[i] = motion;
        }
        moving_.push_back({now.center_ws - motions_[i], motions_[i], now.radius});
    }
    for (const Capsule& capsule : input.capsules) {
        if (!isCapsule(capsule, now_)) continue;
        const Sphere first = now_[capsule.first], second = now_[capsule.second];
        const Float3 from = motions_[capsule.first], to = motions_[capsule.second];
        forEachAlongCapsule(first, second, [&](const Sphere& between, float share) {
            const Float3 motion = from + (to - from) * share;
            moving_.push_back({between.center_ws - motion, motion, between.radius});
        });
    }
    last_.assign(now_.begin(), now_.end());
}

}  // namespace hairloom::runtime
