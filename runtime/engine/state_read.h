// SPDX-License-Identifier: MIT
#pragma once
// What can be told from a state alone, whoever has moved it.

#include <cstdint>
#include <span>

#include "engine/state.h"
#include "hairloom/engine.h"

namespace hairloom::runtime {

/// Strand after strand, root to tip, in the order that makeRestShape() was given; metres, world.
void readPositions(const RestShape& shape, const State& state, std::span<Float3> positions_ws);
/// In the same order, metres per second over the last substep.
void readVelocities(const RestShape& shape, const State& state, std::span<Float3> velocities_ws);
/// `skinSpheres`: as Engine::setSkinSpheres() has them; what is inside these is not.
Measurements measureState(const RestShape& shape, const State& state, const SimulationSettings& settings,
                          std::span<const std::uint8_t> skinSpheres = {});

}  // namespace hairloom::runtime
