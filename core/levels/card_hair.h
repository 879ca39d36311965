// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A groom as cards are made from it: the hair that pictures show, at rest, with the colours that Kajiya-Kay's
// shading shows.

#include "core/cards/hair.h"
#include "core/live/groom_scene.h"

namespace hairloom {

/// Follow hairs where the groom has some, its strands otherwise; hidden ones left out, and those of no
/// length. Errors: those of GroomScene::make() and cards::check().
Result<cards::Hair> cardHair(const Groom& groom);

/// What it takes to move all that hair by one frame, milliseconds: follow hairs as the engine has them; 0
/// where strands are drawn that the simulation itself moves. Median of some runs.
double followMilliseconds(const Groom& groom);

}  // namespace hairloom
