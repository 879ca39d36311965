// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Turning single effects of the engine off, to see what they do and cost.

#include <string>
#include <string_view>

#include "hairloom/settings.h"

namespace hairloom {

/// What turns `effect`, named as in EffectReport, off: "simulation.windSpeed=0". Empty, and nothing changed,
/// where no setting does, as for torsion and continuous collision, which follow from the hair's
/// shape and its speed, and for collision, body and pose, which go with the spheres, the body and the poses.
std::string turnEffectOff(runtime::SimulationSettings& settings, std::string_view effect);

/// Whether there is a way to turn it off: by a setting, by the amounts of poses, or by taking spheres or body
/// away.
bool canTurnOff(runtime::SimulationSettings settings, std::string_view effect);

inline constexpr std::string_view kCollisionEffect = "collision";
/// Contact with the skin of the groom's body.
inline constexpr std::string_view kBodyEffect = "body";
/// Strands that follow poses.
inline constexpr std::string_view kPoseEffect = "pose";

}  // namespace hairloom
