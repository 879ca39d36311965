// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/job.h"
#include "core/groom/groom.h"

namespace hairloom::cli {

/// What hairloom/stable.h has to say of the groom's settings in frames of `frameTime` seconds; null where all
/// is well. Warns as well.
Report adviceReport(const Groom& groom, float frameTime);

}  // namespace hairloom::cli
