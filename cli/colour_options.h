// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The colours of images, as jobs that write them are asked for them.

#include <CLI/App.hpp>

#include "cli/job.h"
#include "core/colour/colour_choice.h"

namespace hairloom::cli {

/// Adds --color-config, --display and --view-transform. `choice` must outlive the job.
void addColourOptions(CLI::App& job, colour::ColourChoice& choice);

/// Config, display, view, and the space of scene-linear files with its chromaticities.
Report colourReport(const colour::Colours& colours);

}  // namespace hairloom::cli
