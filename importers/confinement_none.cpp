// SPDX-License-Identifier: GPL-3.0-or-later
// Systems whose means Hairloom does not use: limits of time and memory are all that holds there.

#include "importers/confinement.h"

namespace hairloom {

Confinement confineProcess(const std::filesystem::path&, std::uint64_t) {
    Confinement confinement;
    for (const char* name : {"memory", "processes", "paths", "files", "system_calls"})
        confinement.layers.push_back({name, LayerState::Missing, "not made use of on this system"});
    return confinement;
}

void endWithParent() {}

std::vector<ConfinementTrial> tryToEscape(const ConfinementBait&) {
    std::vector<ConfinementTrial> trials;
    for (const char* what :
         {"network", "write", "other_files", "stat", "signals", "limits", "memory", "code", "programs"})
        trials.push_back({what, false});
    return trials;
}

}  // namespace hairloom
