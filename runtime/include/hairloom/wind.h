// SPDX-License-Identifier: MIT
#pragma once
// Wind as smoothed random vectors in space and time (Rünz 2012, Section 3.3): a mean flow and a sum of random
// waves. Holds no state, so that any time can be asked for in any order.

#include <array>
#include <cstdint>
#include <optional>

#include "hairloom/settings.h"

namespace hairloom::runtime {

/// One wave of gusts: velocity amplitude · sin(2π · (waveVector · x + turns)).
struct WindMode {
    Float3
        amplitude;  ///< m/s; across waveVector, so that the field has no divergence. Not of WindKind::gusting
    Float3 waveVector;     ///< turns per metre
    float turnsPerSecond;  ///< Hz, at a fixed position: that of the drift with the mean flow is part of it
    float turns;           ///< phase at time 0, 0…1
};

inline constexpr std::uint32_t kWindModes = 6;

/// The wind of one frame. uniform: mean. gusting: mean · (1 + strength · s) with a smooth random s of −1…1
/// whose root mean square is 0.7, so that it never turns round. turbulent and vehicle: mean and eddies whose
/// root mean square is windGustiness · speed, which drift with the authored mean flow (Taylor's frozen
/// turbulence) and change at windFrequency on their way. Eddies that pass within two frames alias.
struct Wind {
    WindKind kind;
    Float3 mean;     ///< m/s
    float strength;  ///< 0…1, of WindKind::gusting
    std::array<WindMode, kWindModes> modes;
};

/// What a frame gives besides the settings; both finite.
struct WindInput {
    std::optional<Float3> mean_ws;  ///< m/s; replaces direction and speed
    Float3 actorVelocity_ws;        ///< m/s; taken off the air's velocity where the kind is vehicle
};

/// The phases of the eddies follow from the authored flow alone, so that they do not jump when the input
/// changes.
Wind makeWind(const SimulationSettings& settings, const WindInput& input = {});

/// Phase of each mode at that time, in turns, −0.5…0.5, for positions that are measured from `origin_ws`,
/// metres.
std::array<float, kWindModes> windPhases(const Wind& wind, double time,
                                         const std::array<double, 3>& origin_ws = {});

}  // namespace hairloom::runtime
