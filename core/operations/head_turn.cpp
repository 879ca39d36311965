// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/head_turn.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/geometry/closest_point.h"

namespace hairloom {
namespace {

constexpr std::size_t kPlaces = 800;
constexpr int kRounds = 12;
constexpr std::size_t kGrain = 64;
constexpr float kPlain = 0.6f;       ///< a turn is plain where it leaves this share of the distance
constexpr float kSmall_m = 0.0015f;  ///< heads nearer than that to each other are alike as they are

/// Vertices of the old head about where its hair grows, face and ears with them, on the new one.
std::vector<Vec3f> placesOf(const Groom& groom, const HeadFit& fit) {
    Vec3f middle = Vec3f::Zero();
    const auto strands = static_cast<float>(groom.strandCount());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) middle += groom.strand(s)[0] / strands;
    float radius = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        radius = std::max(radius, (groom.strand(s)[0] - middle).norm());
    constexpr float kAround = 1.25f;
    std::vector<Vec3f> places;
    for (const Vec3f& vertex : groom.scalp->positions()) {
        if ((vertex - middle).norm() <= kAround * radius) places.push_back(fit.scale * vertex + fit.shift);
    }
    const std::size_t step = std::max<std::size_t>(1, places.size() / kPlaces);
    std::vector<Vec3f> some;
    for (std::size_t i = 0; i < places.size(); i += step) some.push_back(places[i]);
    return some;
}

/// Mean distance of the places to the head, moved without turning to where they lie nearest.
float distanceTo(const SurfaceTree& tree, std::vector<Vec3f> places) {
    std::vector<Vec3f> off(places.size());
    Vec3f mean = Vec3f::Zero();
    for (int round = 0; round <= kRounds; ++round) {
        for (Vec3f& place : places) place += mean;
        parallelFor(places.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) off[i] = tree.closest(places[i]).position - places[i];
        });
        mean.setZero();
        for (const Vec3f& each : off) mean += each / static_cast<float>(off.size());
    }
    float sum = 0;
    for (const Vec3f& each : off) sum += each.norm() / static_cast<float>(off.size());
    return sum;
}

}  // namespace

HeadTurn nearestTurn(const Groom& groom, const ScalpMesh& head, const HeadFit& fit) {
    HeadTurn found;
    const std::vector<Vec3f> places = placesOf(groom, fit);
    if (places.empty()) return found;
    const SurfaceTree tree(head);
    Vec3f middle = Vec3f::Zero();
    for (const Vec3f& place : places) middle += place / static_cast<float>(places.size());
    found.unturned = found.distance = distanceTo(tree, places) / fit.scale;
    if (found.unturned < kSmall_m) return found;
    int nearest = 0;
    for (int quarter = 1; quarter < 4; ++quarter) {
        // The old head turned the other way lies on the new one as the new one turned does on the old.
        const Eigen::AngleAxisf turn(-0.5f * kPi * static_cast<float>(quarter), Vec3f::UnitY());
        std::vector<Vec3f> turned;
        for (const Vec3f& place : places) turned.push_back(middle + turn * Vec3f(place - middle));
        const float distance = distanceTo(tree, std::move(turned)) / fit.scale;
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
