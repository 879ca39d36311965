// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/former_names.h"

#include <algorithm>

namespace hairloom {

std::span<const FormerMember> formerMembers(const HairMaterial&) {
    static const std::vector<FormerMember> kMembers{
        {"colourSource", "dyed", {{false, "melanin"}, {true, "colours"}}},
        {"streakColourSource", "streakDyed", {{false, "melanin"}, {true, "colours"}}},
    };
    return kMembers;
}

std::span<const FormerMember> formerMembers(const PlacementSettings&) {
    static const std::vector<FormerMember> kMembers{
        {"placement", "darts", {{false, "random"}, {true, "poissonDisk"}}},
    };
    return kMembers;
}

std::span<const FormerMember> formerMembers(const runtime::SimulationSettings&) {
    static const std::vector<FormerMember> kMembers{
        {"collisionRadiusRoot", "pearlRadiusRoot", {}},
        {"collisionRadiusTip", "pearlRadiusTip", {}},
        {"angularMethod", "angularMethod", {{"cheap", "smallAngle"}}},
    };
    return kMembers;
}

std::string_view currentName(std::span<const FormerMember> members, std::string_view name) {
    const auto member = std::ranges::find(members, name, &FormerMember::former);
    return member == members.end() ? name : std::string_view(member->name);
}

const nlohmann::json& currentValue(std::span<const FormerMember> members, std::string_view name,
                                   const nlohmann::json& value) {
    const auto member = std::ranges::find(members, name, &FormerMember::name);
    if (member == members.end()) return value;
    const auto known = std::ranges::find(member->values, value, &FormerValue::former);
    return known == member->values.end() ? value : known->now;
}

}  // namespace hairloom
