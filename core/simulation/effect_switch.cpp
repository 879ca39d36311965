// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/effect_switch.h"

#include <fmt/format.h>

#include <cassert>

#include "hairloom/effects.h"

namespace hairloom {

std::string turnEffectOff(runtime::SimulationSettings& settings, std::string_view effect) {
    // Rods have no other length.
    if (effect == "length" && settings.strandModel == runtime::StrandModel::rods) return {};
    runtime::SimulationSettings changed = settings;
    std::string how;
    for (const runtime::EffectInfo& info : runtime::kEffects) {
        if (effect != info.name) continue;
        for (const char* name : info.turnedOffBy) {
            if (!name) break;
            const auto* field = runtime::findField<runtime::SimulationSettings>(name);
            assert(field);
            for (std::uint32_t c = 0; c < field->components(); ++c) {
                if (!runtime::setFieldValue(changed, *field, 0, c)) return {};
            }
            how += fmt::format("{}simulation.{}=0", how.empty() ? "" : ", ", field->name);
        }
    }
    settings = changed;
    return how;
}

bool canTurnOff(runtime::SimulationSettings settings, std::string_view effect) {
    return effect == kCollisionEffect || effect == kBodyEffect || effect == kPoseEffect ||
           !turnEffectOff(settings, effect).empty();
}

}  // namespace hairloom
