// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is measured again and again: a head of hair that turns, and guides with the hairs that follow them.
// Made from numbers alone, so that every program and machine has the same.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include "hairloom/engine.h"
#include "hairloom/follow.h"

namespace hairloom::scenes {

using runtime::Float3;
using runtime::Quat;

/// Roots spread evenly over the upper three quarters of a sphere, strands of 0.3 m that curve down or stand
/// straight out, and ten spheres: the head and nine around the shoulders. The head turns to and fro once a
/// second.
struct HeadOfHair {
    static constexpr float kHeadRadius = 0.09f;        ///< metres
    static constexpr float kStrandLength = 0.3f;       ///< metres
    static constexpr float kGoldenTurn = 2.39996323f;  ///< radians from one root to the next

    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions;
    std::vector<Float3> roots;
    std::vector<runtime::Sphere> spheres;

    HeadOfHair(std::uint32_t strands, std::uint32_t points, bool straight = false) {
        positions.reserve(std::size_t{strands} * points);
        for (std::uint32_t s = 0; s < strands; ++s) {
            const float y = 1.0f - 1.5f * (static_cast<float>(s) + 0.5f) / static_cast<float>(strands);
            const float turn = static_cast<float>(s) * kGoldenTurn;
            const float ring = std::sqrt(1.0f - y * y);
            addStrand({ring * std::cos(turn), y, ring * std::sin(turn)}, points, straight);
        }
        spheres.push_back({{0.0f, 0.0f, 0.0f}, 0.088f});
        for (int i = 0; i < 9; ++i) {
            const float a = static_cast<float>(i) * std::numbers::pi_v<float> / 4.5f;
            spheres.push_back({{0.12f * std::cos(a), -0.2f, 0.08f * std::sin(a)}, 0.06f});
        }
    }

    runtime::StrandsView view() const { return {offsets, positions}; }
    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(roots.size()); }

    /// Where the roots are at that time, in seconds. Sizes `frames` to the strands.
    void placeRoots(double time, std::vector<runtime::RootFrame>& frames) const {
        const float angle =
            0.3f * static_cast<float>(std::sin(2.0 * std::numbers::pi * std::fmod(time, 1.0)));
        const Quat turn{0.0f, std::sin(angle / 2.0f), 0.0f, std::cos(angle / 2.0f)};
        frames.resize(roots.size());
        for (std::size_t s = 0; s < roots.size(); ++s) frames[s] = {rotate(turn, roots[s]), turn};
    }

  private:
    void addStrand(Float3 direction, std::uint32_t points, bool straight) {
        // Strands of more points have about the shape of those of 16.
        const float bend = 0.25f * 15.0f / static_cast<float>(points - 1);
        Float3 at = direction * kHeadRadius;
        roots.push_back(at);
        for (std::uint32_t p = 0; p < points; ++p) {
            positions.push_back(at);
            if (!straight) {
                direction = direction + Float3{0.0f, -bend, 0.0f};
                direction = direction * (1.0f / length(direction));
            }
            at = at + direction * (kStrandLength / static_cast<float>(points - 1));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
};

/// What acts on the head of hair.
enum class ActiveForces : std::uint32_t {
    nothing,         ///< every effect is off: roots and integrator
    gravity,         ///< the engine's defaults without air, no spheres
    windAndSpheres,  ///< the engine's defaults in a turbulent wind of 4 m/s, and the ten spheres
    noTorsion,       ///< the same on straight hair, which needs no frames along its strands
};
inline constexpr ActiveForces kActiveForces[] = {ActiveForces::nothing, ActiveForces::gravity,
                                                 ActiveForces::windAndSpheres, ActiveForces::noTorsion};

constexpr bool hasSpheres(ActiveForces activeForces) {
    return activeForces == ActiveForces::windAndSpheres || activeForces == ActiveForces::noTorsion;
}
constexpr bool isStraight(ActiveForces activeForces) {
    return activeForces == ActiveForces::noTorsion;
}

constexpr std::string_view nameOf(ActiveForces activeForces) {
    switch (activeForces) {
        case ActiveForces::nothing:
            return "all effects off";
        case ActiveForces::gravity:
            return "no air, no spheres";
        case ActiveForces::windAndSpheres:
            return "wind and ten spheres";
        case ActiveForces::noTorsion:
            break;
    }
    return "straight hair, wind and ten spheres";
}

inline runtime::SimulationSettings settingsFor(ActiveForces activeForces, runtime::StrandModel model) {
    runtime::SimulationSettings s;
    s.strandModel = model;
    if (model == runtime::StrandModel::springs) s.substeps = runtime::kSpringSubsteps;
    s.sleepSpeed = 0.0f;
    if (hasSpheres(activeForces)) {
        s.windSpeed = 4.0f;
    } else {
        s.airDrag = 0.0f;
    }
    // What stands straight under gravity would be curved without it.
    if (isStraight(activeForces)) s.restGravity = 0.0f;
    if (activeForces == ActiveForces::nothing) {
        s.angularStiffness = 0.0f;
        s.lengthIterations = 0;
        s.gravity = {};
        s.dampingTime = 0.0f;
    }
    return s;
}

/// Guides on a lattice, curved over and moving; each hair of a guide lies in the triangle of the guide and
/// two neighbours, and in a wisp about the guide.
struct Lawn {
    static constexpr std::uint32_t kColumns = 20;

    std::uint32_t pointsPerHair;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions, velocities;
    std::vector<Quat> rotations;
    std::vector<runtime::RootPlane> planes;
    std::vector<float> radii;
    std::vector<std::array<std::uint32_t, 3>> guides;
    std::vector<Float3> weights, rootShifts;
    std::vector<std::array<float, 2>> wispOffsets;
    std::vector<float> blends;

    /// `guideCount` is a multiple of kColumns, above it; `blend` 0 wisps … 1 triangles.
    Lawn(std::uint32_t guideCount, std::uint32_t hairsPerGuide, std::uint32_t points, float blend)
        : pointsPerHair(points), rotations(guideCount), planes(guideCount) {
        for (std::uint32_t g = 0; g < guideCount; ++g) {
            planes[g] = {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}};
            const Float3 root{0.005f * static_cast<float>(g % kColumns), 0.0f,
                              0.005f * static_cast<float>(g / kColumns)};
            for (std::uint32_t i = 0; i < points; ++i) {
                const float t = static_cast<float>(i) / static_cast<float>(points - 1);
                positions.push_back(root + Float3{0.05f * t * t, 0.2f * t, 0.01f * std::sin(6.0f * t)});
                velocities.push_back({t, 0.0f, 0.3f * t});
            }
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
            addHairs(g, guideCount, hairsPerGuide, blend);
        }
        for (std::uint32_t i = 0; i < points; ++i) radii.push_back(0.002f + 0.0001f * static_cast<float>(i));
    }
    runtime::FollowView view() const {
        return {offsets, {},      planes,      pointsPerHair, radii,     guides,
                weights, weights, wispOffsets, blends,        rootShifts};
    }
    runtime::GuideMotion motion() const { return {positions, velocities, rotations}; }
    std::size_t hairPointCount() const { return guides.size() * pointsPerHair; }

  private:
    void addHairs(std::uint32_t guide, std::uint32_t guideCount, std::uint32_t count, float blend) {
        for (std::uint32_t h = 0; h < count; ++h) {
            const float share = static_cast<float>(h) / static_cast<float>(count);
            const std::uint32_t beside = guide % kColumns + 1 < kColumns ? guide + 1 : guide - 1;
            const std::uint32_t behind = guide + kColumns < guideCount ? guide + kColumns : guide - kColumns;
            guides.push_back({guide, beside, behind});
            weights.push_back({0.5f, 0.5f * share, 0.5f - 0.5f * share});
            rootShifts.push_back({0.0f, 0.0f, 1e-4f * share});
            wispOffsets.push_back({std::cos(40.0f * share), share * std::sin(40.0f * share)});
            blends.push_back(blend);
        }
    }
};

}  // namespace hairloom::scenes
