// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hairloom/settings.h"

namespace hairloom {

/// Strands as rods that carry their weight in the authored shape, so that it holds under gravity.
inline void carryWeight(runtime::SimulationSettings& settings) {
    settings.strandModel = runtime::StrandModel::rods;
    settings.restGravity = 1;
}

}  // namespace hairloom
