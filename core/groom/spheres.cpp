// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/spheres.h"

#include <algorithm>
#include <limits>

#include "hairloom/capsules.h"

namespace hairloom {

runtime::Sphere toSphere(const Vec3f& centre, float radius) {
    return {{centre.x(), centre.y(), centre.z()}, radius};
}

std::vector<runtime::Capsule> capsulesOf(std::span<const CollisionSphere> spheres) {
    std::vector<runtime::Capsule> capsules;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        const std::int32_t other = spheres[s].joined;
        if (other < 0 || static_cast<std::size_t>(other) >= spheres.size() ||
            static_cast<std::size_t>(other) == s)
            continue;
        capsules.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(other)});
    }
    return capsules;
}

std::vector<CollisionSphere> keptSpheres(std::span<const CollisionSphere> spheres,
                                         const std::function<bool(std::size_t)>& keeps) {
    std::vector<std::int32_t> numbers(spheres.size(), -1);
    std::int32_t count = 0;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        if (keeps(s)) numbers[s] = count++;
    }
    std::vector<CollisionSphere> kept;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        if (numbers[s] < 0) continue;
        kept.push_back(spheres[s]);
        std::int32_t& joined = kept.back().joined;
        const bool isThere = joined >= 0 && static_cast<std::size_t>(joined) < spheres.size();
        joined = isThere ? numbers[static_cast<std::size_t>(joined)] : -1;
    }
    return kept;
}

void appendSpheres(std::vector<CollisionSphere>& spheres, std::span<const CollisionSphere> more) {
    const auto first = static_cast<std::int32_t>(spheres.size());
    for (CollisionSphere sphere : more) {
        if (sphere.joined >= 0) sphere.joined += first;
        spheres.push_back(std::move(sphere));
    }
}

ColliderDistance::ColliderDistance(std::span<const CollisionSphere> spheres, std::span<const Vec3f> centres)
    : capsules_(capsulesOf(spheres)) {
    for (std::size_t s = 0; s < spheres.size(); ++s)
        spheres_.push_back(
            toSphere(centres.size() == spheres.size() ? centres[s] : spheres[s].centre, spheres[s].radius));
}

float ColliderDistance::operator()(const Vec3f& point) const {
    const runtime::Float3 place{point.x(), point.y(), point.z()};
    float nearest = std::numeric_limits<float>::infinity();
    const auto meet = [&](const runtime::Sphere& sphere) {
        nearest = std::min(nearest, runtime::length(place - sphere.center_ws) - sphere.radius);
    };
    std::ranges::for_each(spheres_, meet);
    for (const runtime::Capsule& capsule : capsules_)
        meet(runtime::nearestOfCapsule(spheres_[capsule.first], spheres_[capsule.second], place));
    return nearest;
}

}  // namespace hairloom
