// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/job.h"
#include "core/editing/sphere_fit.h"

namespace hairloom::cli {

/// How closely spheres lie: worst_gap_mm, mean_gap_mm, worst_bulge_mm.
void addFit(Report& report, const editing::SphereFit& fit);

}  // namespace hairloom::cli
