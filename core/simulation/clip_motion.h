// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A character's clip as the motion of a head.

#include <memory>
#include <string_view>

#include "core/animation/actor.h"
#include "core/simulation/motion.h"

namespace hairloom {

/// Poses of a character as poses of a groom's head: spheres and body follow the bones of their names.
class CharacterPoser {
  public:
    /// Error: a character whose mesh is not the groom's scalp.
    static Result<CharacterPoser> make(std::shared_ptr<const Actor> actor, const Groom& groom);

    const Actor& actor() const { return *actor_; }
    HeadPose pose(ActorPose posed) const;

  private:
    CharacterPoser(std::shared_ptr<const Actor> actor, const Groom& groom);

    std::shared_ptr<const Actor> actor_;
    std::vector<CollisionSphere> spheres_;
    std::vector<CollisionSphere> bodyBones_;  ///< stand for the bones of the groom's body
};

/// Plays a clip of the character in a loop, from its first frame. Errors: no clip of that name (listing those
/// there are); those of CharacterPoser.
Result<std::unique_ptr<HeadMotion>> makeClipMotion(std::shared_ptr<const Actor> actor, std::string_view clip,
                                                   const Groom& groom);

}  // namespace hairloom
