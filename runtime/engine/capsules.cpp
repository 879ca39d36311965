// SPDX-License-Identifier: MIT
#include "hairloom/capsules.h"

#include <algorithm>
#include <cmath>

namespace hairloom::runtime {

Sphere nearestOfCapsule(const Sphere& first, const Sphere& second, Float3 place_ws) {
    const Float3 axis = second.center_ws - first.center_ws, to = place_ws - first.center_ws;
    const float size = length(axis), narrows = first.radius - second.radius;
    // One end holds the other.
    if (!(size > std::abs(narrows))) return narrows > 0.0f ? first : second;
    // The surface's normal leans by the cone's angle, of sine `lean`, off the perpendicular.
    const float lean = narrows / size, along = dot(to, axis) / size;
    const float off = std::sqrt(std::max(dot(to, to) - along * along, 0.0f));
    const float place = along - off * lean / std::sqrt(1.0f - lean * lean);
    return sphereOfCapsule(first, second, std::clamp(place / size, 0.0f, 1.0f));
}

std::size_t countAlongCapsule(const Sphere& first, const Sphere& second) {
    constexpr float kBump = 5e-4f;  // metres
    const float size = length(second.center_ws - first.center_ws);
    if (!(size > std::abs(first.radius - second.radius))) return 0;
    const float thinnest = std::min(first.radius, second.radius);
    // r − √(r² − (d/2)²) = bump for spheres of radius r that are d apart.
    const float apart = 2.0f * std::sqrt(kBump * std::max(2.0f * thinnest - kBump, thinnest));
    const float count = std::ceil(size / apart) - 1.0f;
    if (!(count > 0.0f)) return 0;  // nor where lengths leave single precision
    return static_cast<std::size_t>(std::clamp(count, 0.0f, static_cast<float>(kMaxAlongCapsule)));
}

Sphere sphereOfCapsule(const Sphere& first, const Sphere& second, float share) {
    return {first.center_ws + (second.center_ws - first.center_ws) * share,
            first.radius + (second.radius - first.radius) * share};
}

bool isCapsule(const Capsule& capsule, std::span<const Sphere> spheres) {
    const auto is = [&](std::uint32_t end) { return end < spheres.size() && spheres[end].radius > 0.0f; };
    return is(capsule.first) && is(capsule.second) && capsule.first != capsule.second;
}

void appendCapsules(std::span<const Capsule> capsules, std::vector<Sphere>& spheres) {
    const std::size_t given = spheres.size();
    for (const Capsule& capsule : capsules) {
        if (!isCapsule(capsule, std::span<const Sphere>(spheres).first(given))) continue;
        const Sphere first = spheres[capsule.first], second = spheres[capsule.second];
        forEachAlongCapsule(first, second, [&](const Sphere& sphere, float) { spheres.push_back(sphere); });
    }
}

}  // namespace hairloom::runtime
