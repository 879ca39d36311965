// SPDX-License-Identifier: MIT
#pragma once
// Tapered capsules as spheres, for what meets spheres alone.

#include <cstddef>
#include <span>
#include <vector>

#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Spheres along a capsule, at most.
inline constexpr std::size_t kMaxAlongCapsule = 16;

/// Of a capsule's spheres the one whose surface is nearest to a place, by signed distance.
Sphere nearestOfCapsule(const Sphere& first, const Sphere& second, Float3 place_ws);
/// How many spheres between the two ends stand for a capsule, evenly apart: between two of them the surface
/// of the capsule is up to half a millimetre higher, and more where kMaxAlongCapsule are too few.
std::size_t countAlongCapsule(const Sphere& first, const Sphere& second);
/// That of a capsule's spheres whose centre lies at `share` of the way from the first end to the second.
Sphere sphereOfCapsule(const Sphere& first, const Sphere& second, float share);
/// Calls visit(sphere, share) for the spheres that stand for a capsule between its ends.
template <class Visit>
void forEachAlongCapsule(const Sphere& first, const Sphere& second, Visit&& visit) {
    const std::size_t count = countAlongCapsule(first, second);
    for (std::size_t k = 0; k < count; ++k) {
        const float share = static_cast<float>(k + 1) / static_cast<float>(count + 1);
        visit(sphereOfCapsule(first, second, share), share);
    }
}
/// Adds the spheres along capsules, which join spheres of the list. Capsules with an end that is not there or
/// has no radius add none.
void appendCapsules(std::span<const Capsule> capsules, std::vector<Sphere>& spheres);
/// Whether both ends are there and not the same.
bool isCapsule(const Capsule& capsule, std::span<const Sphere> spheres);

}  // namespace hairloom::runtime
