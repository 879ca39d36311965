// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Springs of a chain of levels, fitted to how the groom's strands move.

#include "core/cards/levels.h"
#include "core/groom/groom.h"

namespace hairloom {

/// What springs are fitted to and levels' motion is measured in.
inline constexpr const char* kFitMotion = "nod";
inline constexpr int kFitFrames = 120;
inline constexpr float kFitFrameSeconds = 1.0f / 60;

/// The groom's collision spheres.
std::vector<cards::Collider> collidersOf(const Groom& groom);

/// Simulates the strands that lie nearest to the rig's chains, alone, while the head nods for two seconds,
/// and fits the chain's springs to them, for an engine of `hz` updates a second; cards::Chain::springFit says
/// how near they come, there and at other rates. Springs stay as they are set where there are no chains.
/// Errors: those of Simulation::make(), stopped.
Status fitSpringsOf(const Groom& groom, cards::Chain& chain, float hz, cards::Cancel cancel);

}  // namespace hairloom
