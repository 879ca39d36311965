// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far from the strands levels are while the head moves.

#include "core/cards/levels.h"
#include "core/groom/groom.h"

namespace hairloom {

/// Simulates strands of the groom, evenly chosen, while the head nods for two seconds, and sets
/// cards::Measures::motionPx of the levels that were measured: points of cards go with their chains' springs,
/// a shell goes with the head, and strands are what is simulated. It stays unset where there is nothing that
/// moves. Errors: those of Simulation::make(), stopped.
Status measureMotion(const Groom& groom, cards::Chain& chain, cards::Cancel cancel);

}  // namespace hairloom
