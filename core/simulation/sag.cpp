// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/sag.h"

#include <algorithm>

#include "core/groom/carried_weight.h"
#include "core/groom/spheres.h"
#include "core/simulation/scene_input.h"
#include "core/simulation/simulation.h"

namespace hairloom {
namespace {

constexpr float kFramesPerSecond = 60;
constexpr int kFrames = 120;
constexpr float kInstant = 1e-3f;  // seconds

/// Nothing but weight and contact.
Groom inStillAir(const Groom& groom) {
    Groom still = groom;
    still.simulation.windSpeed = 0;
    still.simulation.sleepSpeed = 0;
    for (GroomPose& pose : still.poses) pose.amount = 0;
    return still;
}

Sag distances(const Groom& groom, std::span<const Vec3f> positions_ws) {
    Sag sag;
    const auto authored = groom.positions();
    double sum = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        float farthest = 0;
        for (std::uint32_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p) {
            const float moved = 1e3f * (positions_ws[p] - authored[p]).norm();
            sum += static_cast<double>(moved);
            farthest = std::max(farthest, moved);
        }
        sag.strandMm.push_back(farthest);
        sag.maxMm = std::max(sag.maxMm, static_cast<double>(farthest));
    }
    sag.meanMm = sum / static_cast<double>(authored.size());
    return sag;
}

/// Spheres that push the groom's hair: rods meet the skin in place of those that stand for it.
std::vector<CollisionSphere> pushingSpheres(const Groom& groom) {
    if (groom.simulation.strandModel != runtime::StrandModel::rods) return groom.spheres;
    const auto ofSkin = skinSpheresOf(groom);
    return keptSpheres(groom.spheres, [&](std::size_t s) { return ofSkin.empty() || ofSkin[s] == 0; });
}

/// How deep the strand's points stand in collision spheres, metres; below 0 outside.
float depthOf(const Groom& groom, const ColliderDistance& distance, std::uint32_t strand) {
    const runtime::SimulationSettings& s = groom.simulation;
    const auto points = groom.strand(strand);
    float deepest = -1e30f;
    for (std::size_t p = s.clampedPoints; p < points.size(); ++p) {
        const float along = static_cast<float>(p) / static_cast<float>(points.size() - 1);
        const float radius = s.collisionRadiusRoot + along * (s.collisionRadiusTip - s.collisionRadiusRoot);
        deepest = std::max(deepest, radius - distance(points[p]));
    }
    return deepest;
}

}  // namespace

Result<Sag> measureSag(const Groom& groom) {
    const Groom still = inStillAir(groom);
    auto instant = Simulation::make(still, HeadPose{});
    if (!instant) return tl::unexpected(instant.error());
    instant->step(kInstant, HeadPose{});
    const double fallen = distances(still, instant->positions_ws()).maxMm;

    auto simulation = Simulation::make(still, HeadPose{});
    if (!simulation) return tl::unexpected(simulation.error());
    for (int frame = 0; frame < kFrames; ++frame) simulation->step(1 / kFramesPerSecond, HeadPose{});
    Sag sag = distances(still, simulation->positions_ws());
    const double gravity = static_cast<double>(runtime::length(groom.simulation.gravity));
    const double free = 1e3 * gravity * static_cast<double>(kInstant) * static_cast<double>(kInstant);
    sag.residual = free > 0 ? fallen / free : 0;
    return sag;
}

Groom holdingItsShape(const Groom& groom) {
    Groom held = groom;
    carryWeight(held.simulation);
    return held;
}

std::vector<SaggingStrand> strandsThatSag(const Groom& groom, const Sag& sag, double limitMm) {
    std::vector<SaggingStrand> strands;
    const auto stiffness = groom.strandAttributes.view<float>(attribute::kStiffness);
    const std::vector<CollisionSphere> spheres = pushingSpheres(groom);
    const ColliderDistance distance(spheres);
    const bool limp = !(runtime::greatestStiffness(groom.simulation) > 0);
    for (std::uint32_t s = 0; s < sag.strandMm.size(); ++s) {
        const auto mm = static_cast<double>(sag.strandMm[s]);
        if (!(mm > limitMm)) continue;
        const float depth = depthOf(groom, distance, s);
        std::string reason = "the strand does not carry its weight";
        if (limp || (!stiffness.empty() && !(stiffness[s] > 0))) {
            reason = "its stiffness is zero";
        } else if (depth > 0) {
            reason = "it is inside a collision sphere or capsule, which pushes it out";
        } else if (groom.simulation.restGravity < 1) {
            reason = "its rest shape carries only part of its weight";
        }
        strands.push_back({s, mm, reason});
    }
    std::ranges::stable_sort(strands,
                             [](const SaggingStrand& a, const SaggingStrand& b) { return a.mm > b.mm; });
    return strands;
}

}  // namespace hairloom
