// SPDX-License-Identifier: MIT
#include "models/rods/rod_slots.h"

#include <array>
#include <cmath>

#include "engine/moving_body.h"

namespace hairloom::runtime {
namespace {

static_assert(HAIRLOOM_ROD_STATE_PLANES == kRodStatePlanes);
static_assert(kRodNoStep == static_cast<float>(HAIRLOOM_ROD_NO_STEP));
static_assert(kRodNoEnergy == static_cast<float>(HAIRLOOM_ROD_NO_ENERGY));
static_assert(kRodLaneRows == 2);

// Planes of RodRest, in threes and fours as the kernel reads them.
constexpr std::array<std::size_t, 3> kQuadTangent{0, 1, 2};
constexpr std::array<std::size_t, 4> kQuadTangentAndBend{0, 1, 2, kRodBendPlane};
constexpr std::array<std::size_t, 4> kQuadRotation{kRodRotationPlane, kRodRotationPlane + 1,
                                                   kRodRotationPlane + 2, kRodRotationPlane + 3};
constexpr std::array<std::size_t, 3> kQuadAxis{kRodAxisPlane, kRodAxisPlane + 1, kRodAxisPlane + 2};
constexpr std::array<std::size_t, 3> kQuadNormal{kRodNormalPlane, kRodNormalPlane + 1, kRodNormalPlane + 2};
constexpr std::array<std::size_t, 1> kQuadMass{kRodMassPlane};

}  // namespace

RodSlots rodsOfSlots(const RestShape& shape, const Slots& slots, const RodRest& rods) {
    const auto quads = [&](std::span<const std::size_t> which) {
        return quadsOfSlots(shape, slots, rods.planes, rods.planeCount(), which);
    };
    const bool bends = rods.parts >= RodParts::bending;
    RodSlots made;
    made.rest = quads(bends ? std::span<const std::size_t>(kQuadTangentAndBend) : kQuadTangent);
    const auto append = [&](const Vector<shaders::float4>& more) {
        made.rest.insert(made.rest.end(), more.begin(), more.end());
    };
    // A chain has the shape that it was authored in.
    append(bends ? quads(kQuadRotation)
                 : Vector<shaders::float4>(made.rest.size(), shaders::float4{0.0f, 0.0f, 0.0f, 1.0f}));
    if (rods.parts >= RodParts::twist) append(quads(kQuadAxis));
    if (rods.parts >= RodParts::section) append(quads(kQuadNormal));
    for (const shaders::float4& quad : quads(kQuadMass)) made.masses.push_back(quad.x);
    for (const std::uint32_t block : slots.blocks)
        made.curved.push_back(rods.curved.empty() ? 0 : rods.curved[block]);
    return made;
}

Vector<shaders::float4> posesOfSlots(const RestShape& shape, const Slots& slots, const RodPoses& poses) {
    constexpr std::array<std::size_t, 4> kPlaceAndRate{0, 1, 2, RodPoses::kRatePlane};
    constexpr std::array<std::size_t, 3> kStrain{RodPoses::kStrainPlane, RodPoses::kStrainPlane + 1,
                                                 RodPoses::kStrainPlane + 2};
    auto quads = quadsOfSlots(shape, slots, poses.planes(), RodPoses::kPlanes, kPlaceAndRate);
    const auto strains = quadsOfSlots(shape, slots, poses.planes(), RodPoses::kPlanes, kStrain);
    quads.insert(quads.end(), strains.begin(), strains.end());
    return quads;
}

Vector<float> rodStateOfSlots(const RestShape& shape, const Slots& slots, const State& state, bool folds) {
    Vector<float> rods;
    const auto append = [&](std::size_t own, std::size_t planes) {
        const Vector<float> values = state.own[own].empty()
                                         ? Vector<float>(planes * slots.planeSize())
                                         : planesOfSlots(shape, slots, state.own[own], planes);
        rods.insert(rods.end(), values.begin(), values.end());
    };
    append(kOwnMotion, kRodMotionPlanes);
    append(kOwnStrains, kRodStrainPlanes);
    append(kOwnLoads, 1);
    const Vector<float> rows = rowsOfSlots(slots, state.own[kOwnLanes].data(), kRodLaneRows);
    rods.insert(rods.end(), rows.begin(), rows.end());
    if (folds) append(kOwnFolds, kFoldPlanes);
    return rods;
}

void rodStateToBlocks(const RestShape& shape, const Slots& slots, std::span<const float> rods, State& state) {
    const auto take = [&](std::size_t own, std::size_t planes) {
        const std::size_t floats = planes * slots.planeSize();
        if (!state.own[own].empty()) planesOfBlocks(shape, slots, rods.first(floats), state.own[own], planes);
        rods = rods.subspan(floats);
    };
    take(kOwnMotion, kRodMotionPlanes);
    take(kOwnStrains, kRodStrainPlanes);
    take(kOwnLoads, 1);
    const std::size_t rows = std::size_t{kRodLaneRows} * slots.count;
    rowsToBlocks(slots, rods.first(rows), kRodLaneRows, state.own[kOwnLanes].data());
    rods = rods.subspan(rows);
    if (!rods.empty()) take(kOwnFolds, kFoldPlanes);
}

shaders::RodConstants rodConstants(const SubstepContext& context, const Wind& wind, float before,
                                   const Slots& slots, std::uint32_t fresh) {
    const Float3 g = context.gravity;
    shaders::RodConstants c{};
    c.gravity = {g.x, g.y, g.z, context.air == Air::none ? 0.0f : context.airDrag};
    c.numbers = context.numbers.as<RodNumbers>();
    c.stepRatio = before > 0.0f ? context.h / before : kFirstStepRatio;
    c.points = slots.points;
    c.sweeps = context.sweeps ? 1 : 0;
    c.capsules = static_cast<std::uint32_t>(context.capsules.size());
    c.conservative = context.air == Air::moving ? 0 : context.spheresRest ? 2 : 1;
    c.fresh = fresh;
    for (std::size_t m = 0; m < kWindModes; ++m) {
        const float turns = wind.modes[m].turnsPerSecond * context.h;
        c.windTurns[m] = {turns - std::round(turns), 0.0f, 0.0f, 0.0f};
    }
    return c;
}

}  // namespace hairloom::runtime
