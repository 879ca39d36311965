// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/settings_text.h"

#include <fmt/format.h>

namespace hairloom {

std::string settingsText(const runtime::SimulationSettings& settings) {
    const bool isRods = settings.strandModel == runtime::StrandModel::rods;
    std::string text =
        isRods ? "rods"
               : fmt::format("springs, {}",
                             runtime::integratorNames()[static_cast<std::size_t>(settings.integrator)]);
    text += fmt::format(", {} substep{}", settings.substeps, settings.substeps == 1 ? "" : "s");
    if (settings.windSpeed > 0) text += fmt::format(", wind {:.3g} m/s", settings.windSpeed);
    return text;
}

}  // namespace hairloom
