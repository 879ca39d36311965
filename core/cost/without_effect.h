// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A scene without one of its effects.

#include <optional>
#include <string>
#include <string_view>

#include "core/cost/scene_run.h"

namespace hairloom {

struct WithoutEffect {
    SceneHair hair;
    std::string how;  ///< "simulation.windSpeed=0", "no spheres"
};

/// By the effect's name in EffectReport; nothing where no setting turns it off, as torsion and continuous
/// collision, which follow from the hair's shape and its speed.
std::optional<WithoutEffect> withoutEffect(const SceneHair& hair, std::string_view effect);

}  // namespace hairloom
