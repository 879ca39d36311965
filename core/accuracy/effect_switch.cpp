// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/effect_switch.h"

#include <fmt/format.h>

#include <cassert>

namespace hairloom {
namespace {

/// Fields of the settings, all of whose components become 0.
struct Switch {
    std::string_view effect;
    const char* field;
};
constexpr Switch kSwitches[] = {
    {"damping", "dampingTime"},   {"sleep", "sleepSpeed"},         {"pearls", "pearlRadiusRoot"},
    {"pearls", "pearlRadiusTip"}, {"gravity", "gravity"},          {"drag", "airDrag"},
    {"wind", "windSpeed"},        {"angular", "angularStiffness"}, {"length", "lengthIterations"}};
/// The one that no number turns off: without spheres nothing collides.
constexpr std::string_view kCollision = "collision";

}  // namespace

std::optional<WithoutEffect> withoutEffect(const SceneHair& hair, std::string_view effect) {
    WithoutEffect result{hair, {}};
    if (effect == kCollision) {
        result.hair.groom.spheres.clear();
        result.how = "no spheres";
        return result;
    }
    for (const Switch& entry : kSwitches) {
        if (effect != entry.effect) continue;
        const runtime::FieldInfo* field = runtime::findField(entry.field);
        assert(field);
        for (std::uint32_t c = 0; c < runtime::componentCount(*field); ++c) {
            if (!runtime::setFieldValue(result.hair.groom.simulation, *field, 0, c)) return std::nullopt;
        }
        result.how += fmt::format("{}simulation.{}=0", result.how.empty() ? "" : ", ", field->name);
    }
    if (result.how.empty()) return std::nullopt;
    return result;
}

}  // namespace hairloom
