// SPDX-License-Identifier: MIT
#include "hairloom/body_spheres.h"

#include <cmath>
#include <numbers>

#include "hairloom/capsules.h"

namespace hairloom::runtime {
namespace {

constexpr float kMostBulge = 0.25f;  ///< of the radius

/// Visits places all over a sphere of radius 1, about as far apart from each other.
template <class Visit>
void forEachDirection(Visit&& visit) {
    constexpr int kCount = 128;
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int k = 0; k < kCount; ++k) {
        const double z = 1.0 - (2.0 * k + 1.0) / kCount, across = std::sqrt(1.0 - z * z), turn = golden * k;
        visit(Float3{static_cast<float>(across * std::cos(turn)), static_cast<float>(across * std::sin(turn)),
                     static_cast<float>(z)});
    }
}

bool isOfSkin(const BodyField& field, const Sphere& sphere) {
    if (!(sphere.radius > 0.0f) || !(field.at(sphere.center_ws).distance < 0.0f)) return false;
    bool bulges = false;
    forEachDirection([&](Float3 direction) {
        const float away = field.at(sphere.center_ws + direction * sphere.radius).distance;
        bulges = bulges || (std::isfinite(away) && away > kMostBulge * sphere.radius);
    });
    return !bulges;
}

}  // namespace

Vector<std::uint8_t> spheresOfSkin(const BodyField& field, std::span<const Sphere> spheres_ss,
                                   std::span<const Capsule> capsules) {
    Vector<std::uint8_t> ofSkin(spheres_ss.size());
    for (std::size_t s = 0; s < spheres_ss.size(); ++s) ofSkin[s] = isOfSkin(field, spheres_ss[s]) ? 1 : 0;
    for (const Capsule& capsule : capsules) {
        if (!isCapsule(capsule, spheres_ss)) continue;
        const Sphere &first = spheres_ss[capsule.first], &second = spheres_ss[capsule.second];
        bool all = ofSkin[capsule.first] != 0 && ofSkin[capsule.second] != 0;
        if (all) {
            forEachAlongCapsule(first, second,
                                [&](const Sphere& between, float) { all = all && isOfSkin(field, between); });
        }
        if (!all) ofSkin[capsule.first] = ofSkin[capsule.second] = 0;
    }
    return ofSkin;
}

}  // namespace hairloom::runtime
