// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/head_places.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hairloom {
namespace {

constexpr float kBehindTop = 0.2f;  ///< of the depth of what hair grows on
constexpr double kPersons = 0.28;   ///< metres, diagonal of a box around the scalp of a grown-up
constexpr double kSmallest = 0.7;   ///< of it, that whole head has which is a person's
constexpr double kMost = 1000;      ///< times as large, and the inverse

/// Vertices of the selected faces; all where none is selected.
std::vector<Vec3f> whereHairGrows(const Groom& groom) {
    const auto positions = groom.scalp->positions();
    std::vector<Vec3f> places;
    for (const std::uint32_t face : groom.scalpSelection) {
        for (const std::uint32_t vertex : groom.scalp->triangles()[face]) places.push_back(positions[vertex]);
    }
    if (places.empty()) places.assign(positions.begin(), positions.end());
    return places;
}

Vec3f onSkinBelow(const Groom& groom, float behind) {
    if (!groom.scalp) return Vec3f::Zero();
    const std::vector<Vec3f> places = whereHairGrows(groom);
    Box3f box;
    for (const Vec3f& place : places) box.extend(place);
    const Vec3f above(box.center().x(), box.max().y(), box.center().z() - behind * box.sizes().z());
    return *std::ranges::min_element(places, {},
                                     [&](const Vec3f& place) { return (place - above).squaredNorm(); });
}

}  // namespace

Vec3f topOfHead(const Groom& groom) {
    return onSkinBelow(groom, 0);
}

Vec3f crownOfHead(const Groom& groom) {
    return onSkinBelow(groom, kBehindTop);
}

float headScale(const Groom& groom) {
    if (!groom.scalp) return 1;
    Box3f box;
    for (const Vec3f& place : whereHairGrows(groom)) box.extend(place);
    const double found = double{box.diagonal().norm()} / kPersons;
    // Brows and beards grow on little of a head that is none of a doll.
    const bool isDoll = double{groom.scalp->bounds().diagonal().norm()} < kSmallest * kPersons;
    if (!(found > 0) || (found < 1 && !isDoll)) return 1;
    // The nearest of 1, 2, 5 and 10 times a power of ten, by ratio.
    const double times = std::clamp(found, 1 / kMost, kMost);
    const double decade = std::pow(10.0, std::floor(std::log10(times))), within = times / decade;
    const double step = within < std::sqrt(2.0)    ? 1
                        : within < std::sqrt(10.0) ? 2
                        : within < std::sqrt(50.0) ? 5
                                                   : 10;
    return static_cast<float>(step * decade);
}

}  // namespace hairloom
