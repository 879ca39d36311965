// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/spring_fit.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/geometry/curve.h"
#include "core/groom/spheres.h"
#include "core/groom/strand_subset.h"
#include "core/simulation/simulation.h"
#include "hairloom/capsules.h"

namespace hairloom {
namespace {

static_assert(cards::kSpringHz == 60);

/// A strand near a chain, and its share of how the chain is to move.
struct Near {
    std::uint32_t strand;
    float weight;
};

/// By chains, the strands nearest to each, station by station. `shapes` evenly spaced, empty for strands of
/// no length.
std::vector<std::vector<Near>> nearestStrands(const cards::Rig& rig,
                                              const std::vector<std::vector<Vec3f>>& shapes) {
    constexpr std::size_t kStrands = 8;
    std::vector<std::vector<Near>> nearest(rig.chains());
    for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
        std::vector<Near>& near = nearest[chain];
        for (std::uint32_t s = 0; s < shapes.size(); ++s) {
            if (shapes[s].empty()) continue;
            float apart = 0;  // m²
            for (std::size_t k = 0; k < shapes[s].size(); ++k)
                apart += (shapes[s][k] - rig.curves[chain][k]).squaredNorm();
            near.push_back({s, apart / static_cast<float>(shapes[s].size())});
        }
        const std::size_t kept = std::min(kStrands, near.size());
        std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(kept), {},
                                  [](const Near& n) { return std::pair(n.weight, n.strand); });
        near.resize(kept);
        constexpr float kClose = 1e-4f;  // m²: a centimetre
        float sum = 0;
        for (Near& n : near) sum += n.weight = 1 / (n.weight + kClose);
        for (Near& n : near) n.weight /= sum;
    }
    return nearest;
}

/// How the chains are to move: as the strands near them do, seen from the head.
Result<cards::ChainMotion> motionOf(const Groom& groom, const cards::Rig& rig, const HeadMotion& moving,
                                    cards::Cancel cancel) {
    std::vector<std::vector<Vec3f>> shapes(groom.strandCount());
    for (std::size_t s = 0; s < shapes.size(); ++s)
        if (polylineLength(groom.strand(s)) > 0)
            shapes[s] = resampleEvenly(groom.strand(s), cards::kStations);
    const auto nearest = nearestStrands(rig, shapes);
    std::set<std::uint32_t> needed;
    for (const auto& near : nearest)
        for (const Near& n : near) needed.insert(n.strand);
    const std::vector<std::uint32_t> strands(needed.begin(), needed.end());
    const Groom few = strandsOf(groom, strands);
    std::vector<std::vector<PolylinePlace>> places;
    for (std::size_t s = 0; s < strands.size(); ++s)
        places.push_back(evenPlaces(few.strand(s), rig.perChain));
    auto simulation = Simulation::make(few, moving.poseAt(0));
    if (!simulation) return tl::unexpected(simulation.error());
    const auto at = [&](std::span<const Vec3f> positions, std::size_t strand, std::uint32_t joint) {
        const PolylinePlace& place = places[strand][joint];
        const std::size_t first = few.offsets[strand] + place.segment;
        return Vec3f((1 - place.t) * positions[first] + place.t * positions[first + 1]);
    };
    cards::ChainMotion motion;
    const std::vector<Vec3f> rest(few.positions().begin(), few.positions().end());
    for (int frame = 0; frame <= kFitFrames; ++frame) {
        if (cards::cancelled(cancel)) return cards::stopped();
        const HeadPose pose = moving.poseAt(kFitFrameSeconds * static_cast<float>(frame));
        if (frame > 0) simulation->step(kFitFrameSeconds, pose);
        const Eigen::Isometry3f head = pose.head_ws, toHead = head.inverse();
        const std::span<const Vec3f> now = frame > 0 ? simulation->positions_ws() : rest;
        std::vector<Vec3f> joints;
        for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
            for (std::uint32_t j = 0; j < rig.perChain; ++j) {
                Vec3f moved = rig.joints[1 + chain * rig.perChain + j].position_ws;
                for (const Near& n : nearest[chain]) {
                    const auto strand = static_cast<std::size_t>(std::ranges::lower_bound(strands, n.strand) -
                                                                 strands.begin());
                    moved += n.weight * (toHead * at(now, strand, j) - at(rest, strand, j));
                }
                joints.push_back(head * moved);
            }
        }
        motion.heads_ws.push_back(head);
        motion.joints_ws.push_back(std::move(joints));
    }
    return motion;
}

}  // namespace

std::vector<cards::Collider> collidersOf(const Groom& groom) {
    std::vector<cards::Collider> colliders;
    for (const CollisionSphere& sphere : groom.spheres)
        colliders.push_back({sphere.centre, sphere.radius, sphere.bone});
    // Springs of avatars know capsules of one radius and one bone alone.
    for (const auto& [from, to] : capsulesOf(groom.spheres)) {
        const CollisionSphere &first = groom.spheres[from], &second = groom.spheres[to];
        runtime::forEachAlongCapsule(
            toSphere(first.centre, first.radius), toSphere(second.centre, second.radius),
            [&](const runtime::Sphere& sphere, float share) {
                const auto& [x, y, z] = sphere.center_ws;
                colliders.push_back({{x, y, z}, sphere.radius, share <= 0.5f ? first.bone : second.bone});
            });
    }
    return colliders;
}

Status fitSpringsOf(const Groom& groom, cards::Chain& chain, float hz, cards::Cancel cancel) {
    if (chain.rig.chains() == 0) return {};
    const auto moving = makeRigidMotion(kFitMotion, groom);
    if (!moving) return tl::unexpected(moving.error());
    const auto simulated = motionOf(groom, chain.rig, **moving, cancel);
    if (!simulated) return tl::unexpected(simulated.error());
    const auto wantedAt = [&](float rate) {
        std::vector<Eigen::Isometry3f> heads;
        for (int f = 0; static_cast<float>(f) <= kFitFrames * kFitFrameSeconds * rate + 1e-3f; ++f)
            heads.push_back((*moving)->poseAt(static_cast<float>(f) / rate).head_ws);
        return cards::atRate(*simulated, rate, heads);
    };
    const std::vector<cards::Collider> colliders = collidersOf(groom);
    const cards::ChainMotion wanted = hz == cards::kSpringHz ? *simulated : wantedAt(hz);
    auto fitted = cards::fitSprings(chain.rig, wanted, colliders, cancel);
    if (!fitted) return tl::unexpected(fitted.error());
    cards::SpringFit fit{kFitMotion,
                         kFitFrames / 60.0,
                         hz,
                         {},
                         cards::springError(chain.rig, chain.springs, wanted, colliders),
                         cards::springError(chain.rig, *fitted, wanted, colliders)};
    std::set<float> rates(cards::kEngineHz.begin(), cards::kEngineHz.end());
    rates.insert(hz);
    for (const float rate : rates)
        fit.rates.push_back({rate, rate == hz
                                       ? fit.after
                                       : cards::springError(chain.rig, *fitted, wantedAt(rate), colliders)});
    for (std::size_t c = 0; c < chain.rig.chains(); ++c)
        fit.settlingMm =
            std::max(fit.settlingMm, 1000 * static_cast<double>(settling(chain.rig, c, (*fitted)[c])));
    chain.springFit = std::move(fit);
    chain.springs = std::move(*fitted);
    return {};
}

}  // namespace hairloom
