// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/effect_switch.h"

#include <fmt/format.h>

#include <cassert>

namespace hairloom {
namespace {

/// Fields of the settings, all of whose components become 0.
struct Switch {
    std::string_view effect;
    const char* field;
};
constexpr Switch kSwitches[] = {{"damping", "dampingTime"},
                                {"sleep", "sleepSpeed"},
                                {"collisionRadius", "collisionRadiusRoot"},
                                {"collisionRadius", "collisionRadiusTip"},
                                {"gravity", "gravity"},
                                {"drag", "airDrag"},
                                {"wind", "windSpeed"},
                                {"angular", "angularStiffness"},
                                {"length", "lengthIterations"}};

}  // namespace

std::string turnEffectOff(runtime::SimulationSettings& settings, std::string_view effect) {
    // Rods have no other length.
    if (effect == "length" && settings.strandModel == runtime::StrandModel::rods) return {};
    runtime::SimulationSettings changed = settings;
    std::string how;
    for (const Switch& entry : kSwitches) {
        if (effect != entry.effect) continue;
        const auto* field = runtime::findField<runtime::SimulationSettings>(entry.field);
        assert(field);
        for (std::uint32_t c = 0; c < field->components(); ++c) {
            if (!runtime::setFieldValue(changed, *field, 0, c)) return {};
        }
        how += fmt::format("{}simulation.{}=0", how.empty() ? "" : ", ", field->name);
    }
    settings = changed;
    return how;
}

bool canTurnOff(runtime::SimulationSettings settings, std::string_view effect) {
    return effect == kCollisionEffect || !turnEffectOff(settings, effect).empty();
}

}  // namespace hairloom
