// SPDX-License-Identifier: MIT
#pragma once
// Wind as smoothed random vectors in space and time (Rünz 2012, Section 3.3): a mean flow and a sum of random
// waves.

#include <array>
#include <cstdint>

#include "runtime/settings.h"

namespace hairloom::runtime {

/// One wave of gusts: velocity amplitude · sin(2π · (waveVector · x + turns)).
struct WindMode {
    Float3 amplitude;      ///< m/s
    Float3 waveVector;     ///< turns per metre
    float turnsPerSecond;  ///< Hz
    float turns;           ///< phase, 0…1
};

inline constexpr std::uint32_t kWindModes = 6;

/// The wind of a scene, derived from its settings; holds no state, so that any time can be asked for in any
/// order.
struct Wind {
    Float3 mean;  ///< m/s
    std::array<WindMode, kWindModes> modes;
};

Wind makeWind(const SimulationSettings& settings);

/// Phase of each mode at that time, in turns, −0.5…0.5.
std::array<float, kWindModes> windPhases(const Wind& wind, double time);

}  // namespace hairloom::runtime
