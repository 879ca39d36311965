// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `render --show NAME`: curves and tables of the shading models in place of an image of hair.

#include "cli/job.h"
#include "cli/render_options.h"

namespace hairloom::cli {

/// Writes options.output. Errors: as show(), and what cannot be read or written.
Result<Report> showToFile(const RenderJobOptions& options);

}  // namespace hairloom::cli
