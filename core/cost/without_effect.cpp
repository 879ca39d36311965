// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/without_effect.h"

#include "core/simulation/effect_switch.h"

namespace hairloom {

std::optional<WithoutEffect> withoutEffect(const SceneHair& hair, std::string_view effect) {
    WithoutEffect result{hair, {}};
    if (effect == kCollisionEffect) {
        result.hair.groom.spheres.clear();
        result.how = "no spheres";
    } else if (effect == kBodyEffect) {
        if (hair.groom.body) result.how = "no body";
        result.hair.groom.body.reset();
    } else if (effect == kPoseEffect) {
        // Of what keys them, too.
        if (!hair.groom.poses.empty()) result.how = "no poses";
        result.hair.groom.poses.clear();
    } else {
        result.how = turnEffectOff(result.hair.groom.simulation, effect);
    }
    if (result.how.empty()) return std::nullopt;
    return result;
}

}  // namespace hairloom
