// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The registry of jobs as data, for what makes bindings or forms of it: `reference --jobs`.

#include "cli/job.h"

namespace hairloom::cli {

/// {"options": […], "jobs": [{"name", "does", "example", "options": […]}]}, where the first options are those
/// that every job takes. An option has name (no dashes), argument ("--fps", or null for one that stands by
/// its place), type ("TEXT", "INT", "FLOAT" …; "FLAG" takes no value), choices (list), many (takes several
/// values), required, default (text or null) and meaning.
Report describedJobs();

}  // namespace hairloom::cli
