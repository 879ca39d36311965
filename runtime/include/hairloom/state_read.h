// SPDX-License-Identifier: MIT
#pragma once
// What can be told from a state alone, whoever has moved it.

#include <cstdint>
#include <span>

#include "hairloom/settings.h"
#include "hairloom/state.h"

namespace hairloom::runtime {

/// What the state looks like; taken when asked for, at about the cost of one substep.
struct Measurements {
    std::uint64_t nanCount = 0;  ///< points that are not finite
    double maxStretch = 0.0;  ///< largest |length / rest length − 1|; segments without length do not count
    double maxPenetration =
        0.0;  ///< metres that a free point and its pearl lie inside a sphere of the last frame
    double kineticEnergy = 0.0;  ///< joules, over free points; the points of a strand weigh 1 kg on average
    double potentialEnergy =
        0.0;                   ///< joules, likewise, in the gravity of the settings, 0 at the world's origin
    std::uint32_t asleep = 0;  ///< strands
};

/// Strand after strand, root to tip, in the order that makeRestShape() was given; metres, world.
void readPositions(const RestShape& shape, const State& state, std::span<Float3> positions_ws);
/// In the same order, metres per second over the last substep.
void readVelocities(const RestShape& shape, const State& state, std::span<Float3> velocities_ws);
Measurements measureState(const RestShape& shape, const State& state, const SimulationSettings& settings);

}  // namespace hairloom::runtime
