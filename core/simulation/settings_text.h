// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hairloom/settings.h"

namespace hairloom {

/// What a review wants to know of a simulation, in a line: "rods, 2 substeps, wind 3 m/s".
std::string settingsText(const runtime::SimulationSettings& settings);

}  // namespace hairloom
