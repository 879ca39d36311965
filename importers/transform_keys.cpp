// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/transform_keys.h"

#include <cmath>
#include <optional>
#include <utility>

namespace hairloom {
namespace {

constexpr int kMaxHalvings = 6;  ///< of the time between two samples

bool isNear(const Eigen::Affine3d& a, const Eigen::Affine3d& b) {
    constexpr double kTolerance = 1e-5;
    const double size = a.linear().norm() + 1e-30, length = a.translation().norm() + size;
    return (a.linear() - b.linear()).norm() <= kTolerance * size &&
           (a.translation() - b.translation()).norm() <= kTolerance * length;
}

class Keys {
  public:
    Keys(const std::function<Result<Eigen::Affine3d>(double)>& at,
         const std::function<float(double)>& seconds, Channel& channel)
        : at_(at), seconds_(seconds), channel_(channel) {}

    Result<bool> add(const std::set<double>& times) {
        std::optional<std::pair<double, TransformParts>> last;
        bool isSheared = false;
        for (const double time : times) {
            const auto transform = at_(time);
            if (!transform) return tl::unexpected(transform.error());
            const TransformParts parts = TransformParts::of(*transform);
            isSheared = isSheared || !isNear(*transform, parts.whole());
            if (last && !isSheared) {
                if (auto status = between(last->first, last->second, time, parts, 0); !status)
                    return tl::unexpected(status.error());
            }
            put(time, parts);
            last = std::pair(time, parts);
        }
        return isSheared;
    }

  private:
    /// Angles of a file may go straight from sample to sample, those of keys go the shortest way.
    Status between(double from, const TransformParts& before, double to, const TransformParts& after,
                   int halvings) {
        const double middle = 0.5 * (from + to);
        const auto there = at_(middle);
        if (!there) return tl::unexpected(there.error());
        if (halvings >= kMaxHalvings || isNear(*there, before.towards(after, 0.5).whole())) return {};
        const TransformParts parts = TransformParts::of(*there);
        if (auto status = between(from, before, middle, parts, halvings + 1); !status) return status;
        put(middle, parts);
        return between(middle, parts, to, after, halvings + 1);
    }

    void put(double time, const TransformParts& parts) {
        const float seconds = seconds_(time);
        Track<Vec3f>& places = channel_.translation;
        if (!std::isfinite(seconds) || (!places.times.empty() && seconds < places.times.back())) return;
        if (!places.times.empty() && seconds == places.times.back() && !makePlace(seconds)) {
            places.values.back() = parts.place.cast<float>();
            channel_.rotation.values.back() = parts.turn.cast<float>();
            channel_.scale.values.back() = parts.factors.cast<float>();
            return;
        }
        for (std::vector<float>* const track :
             {&places.times, &channel_.rotation.times, &channel_.scale.times})
            track->push_back(seconds);
        places.values.push_back(parts.place.cast<float>());
        channel_.rotation.values.push_back(parts.turn.cast<float>());
        channel_.scale.values.push_back(parts.factors.cast<float>());
    }

    /// Where motion jumps, two keys would have one time: the last one moves as little as numbers allow. False
    /// where another is there.
    bool makePlace(float seconds) {
        const float before = std::nextafter(seconds, -HUGE_VALF);
        const std::vector<float>& times = channel_.translation.times;
        if (times.size() > 1 && times[times.size() - 2] >= before) return false;
        for (std::vector<float>* const track :
             {&channel_.translation.times, &channel_.rotation.times, &channel_.scale.times})
            track->back() = before;
        return true;
    }

    const std::function<Result<Eigen::Affine3d>(double)>& at_;
    const std::function<float(double)>& seconds_;
    Channel& channel_;
};

}  // namespace

TransformParts TransformParts::of(const Eigen::Affine3d& transform) {
    Eigen::Matrix3d rotation, scale;
    transform.computeRotationScaling(&rotation, &scale);
    return {transform.translation(), scale.diagonal(), Eigen::Quaterniond(rotation).normalized()};
}

TransformParts TransformParts::towards(const TransformParts& other, double share) const {
    return {(1 - share) * place + share * other.place, (1 - share) * factors + share * other.factors,
            turn.slerp(share, other.turn)};
}

Eigen::Affine3d TransformParts::whole() const {
    return Eigen::Translation3d(place) * turn * Eigen::Scaling(factors);
}

Result<bool> addTransformKeys(const std::set<double>& times,
                              const std::function<Result<Eigen::Affine3d>(double)>& at,
                              const std::function<float(double)>& seconds, Channel& channel) {
    return Keys(at, seconds, channel).add(times);
}

}  // namespace hairloom
