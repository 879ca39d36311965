// SPDX-License-Identifier: MIT
#pragma once
// Strands as elastic rods: what they are at rest, and what they remember from step to step (docs/engine.md,
// "Rods").

#include <cstdint>

#include "engine/strand_model.h"
#include "hairloom/memory.h"
#include "models/rods/rod_block.h"

namespace hairloom::runtime {

const Model& rodModel();

/// What of a rod there is: each needs the one before it. What is not has no arrays and no part in the kernel.
enum class RodParts : std::uint8_t {
    chain,    ///< segments that keep their lengths, free to bend
    bending,  ///< resists bending
    twist,    ///< and twist about itself
    section,  ///< and bends more easily about its long diameter
};
/// `straight`: every strand is, at rest.
RodParts rodPartsOf(const SimulationSettings& settings, bool straight);
/// The same of these strands; without a free point there is nothing to resist.
RodParts rodPartsOf(const RestShape& shape, const SimulationSettings& settings);

/// What follows from rest shape and settings; made anew when settings change.
struct RodRest {
    RodParts parts = RodParts::chain;
    /// Per block, as far as there are such parts: RodView's tangent and mass; bend and restRotation; axis;
    /// normal.
    Floats planes;
    Vector<std::uint8_t> curved;  ///< per block: it twists; empty where nothing does

    std::size_t planeCount() const;
};
/// Of a RodRest: planes up to each of RodParts, and where they begin.
inline constexpr std::size_t kRodRestPlanes[] = {4, 9, 12, 15};
inline constexpr std::size_t kRodMassPlane = 3, kRodBendPlane = 4, kRodRotationPlane = 5, kRodAxisPlane = 9,
                             kRodNormalPlane = 12;

/// State::own of rods. Motion: rotation, increment, displacement, velocity, velocityBefore. Strains, where a
/// rod resists bending: strain, strainBefore. Loads, where there are collisions: load. Lanes: turn, energy.
/// Folds, where there is a body: fold.
inline constexpr std::size_t kOwnMotion = 0, kOwnStrains = 1, kOwnLoads = 2, kOwnLanes = 3, kOwnFolds = 4;
inline constexpr std::size_t kRodMotionPlanes = 16, kRodStrainPlanes = 6, kRodLaneRows = 2;
/// With a plane of loads.
inline constexpr std::size_t kRodStatePlanes = kRodMotionPlanes + kRodStrainPlanes + 1;

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

/// The same on any number of the host's threads.
RodRest makeRodRest(const RestShape& shape, const SimulationSettings& settings, const Host& host = {});

/// What rods remember of what they touched.
struct RodTouches {
    bool loads = false, folds = false;
};
RodTouches rodTouchesOf(const State& state);

/// Gives a state the arrays of rods with these parts and touches; those that it has keep their values.
void allocateRods(const RestShape& shape, RodParts parts, RodTouches touches, State& state,
                  const Host& host = {});

/// Makes any state one of these rods: strands that were none go on as rods through their points, and chains
/// that now bend back keep all that they have.
void completeRods(const RestShape& shape, const RodRest& rest, RodTouches touches, State& state);

/// Puts lanes of block `index` at rest on their rows of state.roots, without a step before; their points
/// are there.
void placeRodAtRest(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                    LaneRange lanes);

/// Makes lane `lane` of block `index` a rod that passes through its positions and moves as they do, without
/// twist beyond that at rest.
void placeRodOnPoints(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                      std::uint32_t lane);

/// Settings have changed what energy rods have: what they had tells nothing of what they may have.
void forgetRodEnergy(const RestShape& shape, State& state);

/// The rods of a block of a state that has them.
RodView rodViewOf(const RestShape& shape, const RodRest& rest, State& state, std::size_t index);

/// What the kernels are told of a substep.
RodNumbers rodNumbersOf(const SimulationSettings& settings, const EffectPlan& plan);

}  // namespace hairloom::runtime
