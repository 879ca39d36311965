// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What differs between two JSON documents, member by member.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hairloom {

struct JsonDifference {
    std::string where;  ///< "simulation.substeps", "layers[Fringe].density"
    std::string what;   ///< "changed", "added", "removed" or "reordered"
    nlohmann::ordered_json before,
        after;  ///< values; null where there is none; of "reordered" the names in order
};

/// In order of `before`. Objects are compared member by member. Elements of a list of objects are the same
/// where they have the same "name", if all names are different; else the longest common sequence stays, and
/// of what is left between, those of the same "op" are pairs. Places in lists are names, else indices in the
/// list that has the element, of `after` for both. Other lists are values as a whole. Nothing for equal
/// documents.
std::vector<JsonDifference> differences(const nlohmann::ordered_json& before,
                                        const nlohmann::ordered_json& after);

}  // namespace hairloom
