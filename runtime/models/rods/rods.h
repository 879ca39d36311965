// SPDX-License-Identifier: MIT
#pragma once
// Strands as elastic rods: what they are at rest, and what they remember from step to step (docs/engine.md,
// "Rods").

#include <cstdint>
#include <vector>

#include "engine/state.h"

namespace hairloom::runtime {

/// What follows from rest shape and settings; made anew when settings change.
struct RodRest {
    Floats planes;               ///< per block: RodView's tangent, axis, bend, mass, rest rotation, normal
    std::size_t planeCount = 0;  ///< kRodRestPlanes, or kRodFlatRestPlanes of a flat section
    std::vector<std::uint8_t> curved;  ///< per block: twist matters, by rest curvature or a flat section

    std::size_t bytes() const { return planes.size() * sizeof(float) + curved.size(); }
};
inline constexpr std::size_t kRodRestPlanes = 12;
inline constexpr std::size_t kRodFlatRestPlanes = 15;
inline constexpr std::size_t kRodStatePlanes = 23;
inline constexpr std::size_t kRodLaneRows = 2;

/// What a section bends and twists by, as shares of its stiffer bend: an ellipse of the area of the round
/// fibre that angularStiffness stands for.
struct RodSectionRatios {
    double stiffer = 1.0;  ///< EI₁ over EI of the round fibre
    double twist = 0.0;    ///< (GJ − EI₁)/EI₁
    double flat = 0.0;     ///< (EI₂ − EI₁)/EI₁, about the long diameter; 0 of a round section
};
RodSectionRatios rodSectionRatios(const SimulationSettings& settings);

/// Whether a rod has as much energy of shape and weight under both.
bool haveEqualRodEnergy(const SimulationSettings& a, const SimulationSettings& b);

RodRest makeRodRest(const RestShape& shape, const SimulationSettings& settings);

/// Puts lane `lane` of block `index` at rest on its row of state.roots, without a step before.
void placeRodAtRest(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                    std::uint32_t lane);

/// Makes lane `lane` of block `index` a rod that passes through its positions and moves as they do, without
/// twist beyond that at rest.
void placeRodOnPoints(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                      std::uint32_t lane);

/// Turns segment and vertex `i` of a rod along with its root: what BlockView's positions do not hold.
void turnRodAlong(const BlockView& view, std::size_t i, Quat turn);

/// Settings have changed what energy rods have: what they had tells nothing of what they may have.
void forgetRodEnergy(const RestShape& shape, State& state);

/// The rods of a block; all null where there are none.
RodView rodViewOf(const RestShape& shape, const RodRest& rest, State& state, std::size_t index);

}  // namespace hairloom::runtime
