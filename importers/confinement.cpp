// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/confinement.h"

#include <algorithm>

namespace hairloom {

std::string_view layerStateName(LayerState state) {
    switch (state) {
        case LayerState::Set:
            return "set";
        case LayerState::Missing:
            return "missing";
        case LayerState::Failed:
            return "failed";
    }
    return {};
}

bool Confinement::isSet(std::string_view layer) const {
    const auto found = std::ranges::find(layers, layer, &ConfinementLayer::name);
    return found != layers.end() && found->state == LayerState::Set;
}

std::string Confinement::namesOf(LayerState state) const {
    std::string names;
    for (const ConfinementLayer& layer : layers) {
        if (layer.state != state) continue;
        names += (names.empty() ? "" : ", ") + layer.name + " (" + layer.why + ")";
    }
    return names;
}

}  // namespace hairloom
