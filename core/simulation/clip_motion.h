// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A character's clip as the motion of a head.

#include <memory>
#include <string_view>

#include "core/animation/actor.h"
#include "core/simulation/motion.h"

namespace hairloom {

/// Plays a clip of the character in a loop, from its first frame. Spheres follow the bones of their names.
/// Errors: no clip of that name (listing those there are); a character whose mesh is not the groom's scalp.
Result<std::unique_ptr<HeadMotion>> makeClipMotion(std::shared_ptr<const Actor> actor, std::string_view clip,
                                                   const Groom& groom);

}  // namespace hairloom
