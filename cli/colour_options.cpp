// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/colour_options.h"

#include <cmath>

namespace hairloom::cli {

void addColourOptions(CLI::App& job, colour::ColourChoice& choice) {
    job.add_option(
        "--color-config", choice.config,
        "OpenColorIO config for colours, or none (default: $OCIO, else our own tone curve and sRGB)");
    job.add_option("--display", choice.display, "Display of the config (default: the config's)");
    job.add_option("--view-transform", choice.view, "View of the display (default: the display's)");
}

Report colourReport(const colour::Colours& colours) {
    const colour::WorkingSpace& working = colours.config.working();
    // As they are written in standards: five digits after the point, at most.
    Report chromaticities = Report::array();
    for (const float value : working.linear.chromaticities)
        chromaticities.push_back(std::round(value * 1e5) / 1e5);
    return Report{{"config", colours.config.path().string()},
                  {"display", colours.display},
                  {"view", colours.view},
                  {"scene_linear", working.name},
                  {"chromaticities", std::move(chromaticities)},
                  {"interop_id", working.linear.interopId}};
}

}  // namespace hairloom::cli
