// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Names of settings and of their values as the version before wrote them. They are still read, in files, in
// scripts and on the command line; what is written has the names of now.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

struct FormerValue {
    nlohmann::json former;
    nlohmann::json now;
};

struct FormerMember {
    std::string name;                 ///< of now
    std::string former;               ///< the same where only values have changed
    std::vector<FormerValue> values;  ///< what stands for what; others stand for themselves
};

std::span<const FormerMember> formerMembers(const HairMaterial&);
std::span<const FormerMember> formerMembers(const PlacementSettings&);
std::span<const FormerMember> formerMembers(const runtime::SimulationSettings&);
/// Other settings have the names that they always had.
template <class S>
std::span<const FormerMember> formerMembers(const S&) {
    return {};
}

/// The name of now, whether `name` is that or the former one.
std::string_view currentName(std::span<const FormerMember> members, std::string_view name);
/// The value of now of the member that now has that name.
const nlohmann::json& currentValue(std::span<const FormerMember> members, std::string_view name,
                                   const nlohmann::json& value);

}  // namespace hairloom
