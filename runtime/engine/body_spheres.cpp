// SPDX-License-Identifier: MIT
#include "hairloom/body_spheres.h"

#include <cmath>
#include <numbers>

#include "hairloom/capsules.h"

namespace hairloom::runtime {
namespace {

constexpr float kMostBulge = 0.25f;  ///< of the radius
constexpr int kDirections = 128;

/// Visits places all over a sphere of radius 1, about as far apart from each other.
template <class Visit>
void forEachDirection(Visit&& visit) {
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int k = 0; k < kDirections; ++k) {
        const double z = 1.0 - (2.0 * k + 1.0) / kDirections, across = std::sqrt(1.0 - z * z),
                     turn = golden * k;
        visit(Float3{static_cast<float>(across * std::cos(turn)), static_cast<float>(across * std::sin(turn)),
                     static_cast<float>(z)});
    }
}

bool isOfSkin(const BodyField& field, const Sphere& sphere) {
    if (!(sphere.radius > 0.0f) || !(field.at(sphere.center_ws).distance < 0.0f)) return false;
    bool bulges = false;
    int unknown = 0;
    forEachDirection([&](Float3 direction) {
        const float away = field.at(sphere.center_ws + direction * sphere.radius).distance;
        unknown += std::isfinite(away) ? 0 : 1;
        bulges = bulges || (std::isfinite(away) && away > kMostBulge * sphere.radius);
    });
    // Skin that is open, as at the neck, lets a sphere look out of what the field knows; a hat's lies there.
    return !bulges && unknown <= kDirections / 3;
}

}  // namespace

Vector<std::uint8_t> spheresOfSkin(const BodyField& field, std::span<const Sphere> spheres_ss,
                                   std::span<const Capsule> capsules) {
    Vector<std::uint8_t> ofSkin(spheres_ss.size());
    for (std::size_t s = 0; s < spheres_ss.size(); ++s) ofSkin[s] = isOfSkin(field, spheres_ss[s]) ? 1 : 0;
    Vector<std::uint8_t> inSkin;  // capsules all along
    for (const Capsule& capsule : capsules) {
        bool all = isCapsule(capsule, spheres_ss);
        if (all) {
            forEachAlongCapsule(spheres_ss[capsule.first], spheres_ss[capsule.second],
                                [&](const Sphere& between, float) { all = all && isOfSkin(field, between); });
        }
        inSkin.push_back(all ? 1 : 0);
    }
    // An end that pushes makes its capsules push, and these their other ends.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t c = 0; c < capsules.size(); ++c) {
            if (!isCapsule(capsules[c], spheres_ss)) continue;
            std::uint8_t &first = ofSkin[capsules[c].first], &second = ofSkin[capsules[c].second];
            if ((inSkin[c] != 0 && first != 0 && second != 0) || (first == 0 && second == 0)) continue;
            first = second = 0;
            changed = true;
        }
    }
    return ofSkin;
}

}  // namespace hairloom::runtime
