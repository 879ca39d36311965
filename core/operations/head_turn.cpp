// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/head_turn.h"

#include <algorithm>
#include <vector>

#include "core/geometry/closest_point.h"

namespace hairloom {
namespace {

constexpr std::size_t kPlaces = 800;
constexpr float kPlain = 0.6f;  ///< a turn is plain where it leaves this share of the distance

/// Vertices of the head about where its hair grows, face and ears with them.
std::vector<Vec3f> placesOf(const Groom& groom) {
    constexpr float kAround = 1.25f;
    Vec3f middle = Vec3f::Zero();
    const auto strands = static_cast<float>(groom.strandCount());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) middle += groom.strand(s)[0] / strands;
    float radius = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        radius = std::max(radius, (groom.strand(s)[0] - middle).norm());
    std::vector<Vec3f> near, some;
    for (const Vec3f& vertex : groom.scalp->positions()) {
        if ((vertex - middle).norm() <= kAround * radius) near.push_back(vertex);
    }
    const std::size_t step = std::max<std::size_t>(1, near.size() / kPlaces);
    for (std::size_t i = 0; i < near.size(); i += step) some.push_back(near[i]);
    return some;
}

}  // namespace

HeadTurn nearestTurn(const Groom& groom, const ScalpMesh& head) {
    HeadTurn found;
    const std::vector<Vec3f> places = placesOf(groom);
    if (places.empty()) return found;
    const SurfaceTree tree(head);
    const Vec3f crown = crownOf(*groom.scalp), crownThere = crownOf(head);
    found.unturned = found.distance = static_cast<float>(fitPlaces(places, crown, tree, crownThere).off);
    if (found.unturned < kAlikeHeads_m) return found;
    int nearest = 0;
    for (int quarter = 1; quarter < 4; ++quarter) {
        // The old head turned the other way lies on the new one as the new one turned does on the old.
        const Eigen::AngleAxisf turn(-0.5f * kPi * static_cast<float>(quarter), Vec3f::UnitY());
        std::vector<Vec3f> turned;
        for (const Vec3f& place : places) turned.push_back(crown + turn * Vec3f(place - crown));
        const auto distance = static_cast<float>(fitPlaces(turned, crown, tree, crownThere).off);
        if (distance >= found.distance) continue;
        found.distance = distance;
        nearest = quarter;
    }
    if (found.distance < kPlain * found.unturned) {
        found.degrees = 90 * nearest;
    } else {
        found.distance = found.unturned;
    }
    return found;
}

bool isBeyondScale(const HeadFit& fit) {
    constexpr float kNear = 1e-3f;
    return fit.scale <= kMinHeadScale * (1 + kNear) || fit.scale >= kMaxHeadScale * (1 - kNear);
}

}  // namespace hairloom
